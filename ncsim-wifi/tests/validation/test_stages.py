"""Everything that ``ncsim validate-model`` compares, experiment by experiment."""

from functools import cache

import pytest
from ncsim_wifi.validation import analysis, internal, literature, packet

PARTS = (
    analysis.constants,
    analysis.solver,
    analysis.isolated_links,
    analysis.local_shares,
    internal.experiment_1,
    internal.experiment_2,
    internal.experiment_4,
    internal.experiment_7,
    internal.other_experiments,
    literature.table_3,
    literature.figure_6,
    packet.contention,
    packet.separation,
    packet.overlapping_domains,
    packet.overhead,
    packet.starts_and_stops,
    packet.spatial,
)


@cache
def rows(part):
    return list(part())


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.__name__)
def test_measured_is_as_expected(part):
    failed = [row for row in rows(part) if row.verdict == "FAIL"]

    assert not failed
    assert rows(part)


def test_the_stages_leave_out_no_part(monkeypatch):
    for part in PARTS:
        module = {"analysis": analysis, "internal": internal}.get(
            part.__module__.rpartition(".")[2],
            packet if part.__module__.endswith("packet") else literature,
        )
        monkeypatch.setattr(module, part.__name__, lambda name=part.__name__: iter([name]))

    told = [*internal.rows(), *literature.rows(), *packet.rows()]

    assert told == [part.__name__ for part in PARTS]


def test_all_nine_internal_experiments_and_five_packet_comparisons_are_there():
    numbers = {
        (row.stage, row.experiment[0])
        for part in PARTS
        for row in rows(part)
        if row.experiment[0].isdigit()
    }

    assert numbers == {("internal", str(n)) for n in range(1, 10)} | {
        ("packet", str(n)) for n in range(1, 6)
    }


def test_all_eleven_separations_of_experiment_4_are_compared():
    assert len({row.case for row in rows(internal.experiment_4)}) == 11


def test_the_twelve_markers_of_figure_6_are_compared():
    assert sum(row.source == "marker" for row in rows(literature.figure_6)) == 12


def test_only_packet_comparisons_are_left_without_a_verdict():
    differing = [row for part in PARTS for row in rows(part) if row.verdict == "differs"]

    assert {row.source for row in differing} == {"ns-3"}
