from dataclasses import replace

import numpy as np
import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.registry import get_registry
from ncsim_wifi import tables
from ncsim_wifi.phy.mcs import (
    RateTable,
    parse_table,
    phy_rate_Mbps,
    rate_table,
    read_table,
)
from ncsim_wifi.radio import Radio
from ncsim_wifi.schemas import rf_schema
from ncsim_wifi.tables import table_names
from ncsim_wifi.validation.engine_runs import RAW_PHY, measure
from ncsim_wifi.validation.scenes import single

HEAD = "mcs,snr_min_dB,rate_Mbps"


@pytest.mark.parametrize("name", table_names())
def test_every_table_is_readable_and_rises(name):
    table = read_table(name)

    assert len(table.snr_min_dB) == len(table.rate_Mbps) >= 1


def test_the_three_standards_are_there():
    assert {"n", "ac", "ax"} <= set(table_names())


@pytest.mark.parametrize(
    ("name", "fastest_Mbps", "schemes"), [("n", 65.0, 8), ("ac", 86.7, 10), ("ax", 143.4, 12)]
)
def test_tables_end_where_the_specification_ends_them(name, fastest_Mbps, schemes):
    table = read_table(name)

    assert (table.rate_Mbps[-1], len(table.rate_Mbps)) == (fastest_Mbps, schemes)
    assert table.snr_min_dB[0] == 5.0


def test_rates_are_selected_at_the_threshold_and_not_below():
    snr_dB = np.array([4.999, 5.0, 7.999, 8.0, 41.0, 99.0])

    assert phy_rate_Mbps(snr_dB, read_table("ax")).tolist() == [0.0, 8.6, 8.6, 17.2, 143.4, 143.4]


@pytest.mark.parametrize(("snr_dB", "index"), [(4.999, -1), (5.0, 0), (8.0, 1), (99.0, 11)])
def test_schemes_are_selected_as_rates_are(snr_dB, index):
    assert read_table("ax").index_for(snr_dB) == index


@pytest.mark.parametrize(("width", "factor"), [(20, 1), (40, 2), (80, 4), (160, 8)])
def test_rates_grow_in_proportion_to_the_channel_width(width, factor):
    table = rate_table(Radio(channel_width_mhz=width))

    assert table.rate_Mbps == tuple(factor * rate for rate in read_table("ax").rate_Mbps)
    assert table.snr_min_dB == read_table("ax").snr_min_dB


def test_a_misspelt_standard_is_answered_with_a_suggestion():
    with pytest.raises(ScenarioError, match=r"no rate table 'ax2'.*did you mean 'ax'"):
        read_table("ax2")


def test_a_table_that_does_not_rise_is_refused():
    with pytest.raises(ScenarioError, match="increase strictly"):
        RateTable((5.0, 5.0), (8.6, 17.2))


def test_a_table_is_three_columns_of_text():
    assert parse_table(["mcs,snr_min_dB,rate_Mbps", "0,5,8.6"]) == RateTable((5.0,), (8.6,))


@pytest.fixture
def own_tables(tmp_path, monkeypatch):
    """Put another folder in the place of the tables, also for the schema that a process keeps."""
    monkeypatch.setattr(tables, "FOLDER", tmp_path)
    get_registry.cache_clear()
    yield tmp_path
    get_registry.cache_clear()


def test_a_new_file_is_a_new_standard_from_schema_to_engine(own_tables):
    (own_tables / "slow.csv").write_text("mcs, snr_min_dB, rate_Mbps\n0, 3, 1\n\n1, 20, 4\n")
    radio = Radio(wifi_standard="slow", channel_width_mhz=40)

    far, near = (
        measure(replace(single(length_m), radio=radio), "none", RAW_PHY) for length_m in (60, 30)
    )

    assert rf_schema()["properties"]["wifi_standard"]["enum"] == ["slow"]
    assert far.mean_rate_MBps(0) == pytest.approx(2.0 / 8.0)
    assert near.mean_rate_MBps(0) == pytest.approx(8.0 / 8.0)


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        ([], r"mine\.csv:1  must begin with mcs,snr_min_dB,rate_Mbps, not \[\]"),
        (
            ["mcs,snr,rate", "0,5,6"],
            r"mine\.csv:1  must begin with .* not \['mcs', 'snr', 'rate'\]",
        ),
        ([HEAD], r"mine\.csv  rates and thresholds must increase strictly, not \(\)"),
        ([HEAD, "0,5,6", "1,8,fast"], r"mine\.csv:3  must be three numbers, not '1, 8, fast'"),
        ([HEAD, "0,5"], r"mine\.csv:2  must be three numbers"),
        ([HEAD, "0,nan,6"], r"mine\.csv:2  needs a finite threshold"),
        ([HEAD, "0,5,-6", "1,8,6"], r"mine\.csv:2  needs .* a rate above 0"),
        ([HEAD, "0,8,6", "1,5,7"], r"mine\.csv  rates and thresholds must increase"),
    ],
)
def test_a_file_that_is_no_table_is_refused_with_its_line(lines, told):
    with pytest.raises(ScenarioError, match=told):
        parse_table(lines, "mine.csv")
