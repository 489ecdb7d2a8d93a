import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_wifi.mac.efficiency import (
    data_airtime_fraction,
    efficiency,
    mean_slot_us,
    slot_shares,
    station_goodput_MBps,
)
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.phy.mcs import read_table

RATES_Mbps = read_table("ax").rate_Mbps
BASIC = AxTiming()


@pytest.mark.parametrize(
    ("stations", "rate_Mbps", "expected", "tolerance"),
    [(1, 8.6, 0.834788, 5e-7), (1, 143.4, 0.279415, 5e-7), (100, 68.8, 0.282560850, 5e-10)],
)
def test_efficiency_has_the_published_values(stations, rate_Mbps, expected, tolerance):
    assert efficiency(stations, rate_Mbps, BASIC) == pytest.approx(expected, abs=tolerance)


@given(st.floats(0.001, 0.999), st.integers(1, 300))
def test_slots_are_idle_successful_or_in_collision(tau, stations):
    shares = slot_shares(tau, stations)

    assert sum(shares) == pytest.approx(1.0)
    assert all(0.0 <= share <= 1.0 for share in shares)


def test_a_mean_slot_lies_between_its_parts():
    shares = slot_shares(0.05, 10)

    assert 9.0 < mean_slot_us(shares, 68.8, BASIC) < BASIC.success_us(68.8)


@given(st.integers(1, 400), st.sampled_from(RATES_Mbps), st.booleans())
def test_a_station_gets_less_when_one_more_joins(stations, rate_Mbps, rts_cts):
    timing = AxTiming(rts_cts)

    assert 0.0 < efficiency(stations, rate_Mbps, timing) < 1.0
    fewer, more = (station_goodput_MBps(n, rate_Mbps, timing) for n in (stations, stations + 1))
    assert more < fewer


@given(st.integers(1, 100), st.booleans())
def test_a_higher_rate_never_delivers_less(stations, rts_cts):
    goodputs = [station_goodput_MBps(stations, r, AxTiming(rts_cts)) for r in RATES_Mbps]

    assert goodputs == sorted(goodputs)


def test_no_rate_no_goodput():
    assert station_goodput_MBps(3, 0.0, BASIC) == 0.0


def test_the_solo_goodput_at_thirty_metres_is_the_published_one():
    assert station_goodput_MBps(1, 68.8, BASIC) == pytest.approx(3.783, abs=5e-4)


def test_a_lone_station_sends_data_sixty_percent_of_the_time_at_mcs_5():
    airtime = data_airtime_fraction(68.8, BASIC)

    assert station_goodput_MBps(1, 68.8, BASIC) * (1 - airtime) == pytest.approx(1.504, abs=5e-4)
