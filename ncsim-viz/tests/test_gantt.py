from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.api import result_of
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.loading import load_run
from ncsim_viz.gantt import Bar, Chart, chart_of_result, chart_of_run, rows_of
from ncsim_viz.svg import svg_gantt
from ncsim_viz.terminal import TerminalSize, drawn, terminal_gantt

times = st.integers(0, 20).map(float)
bars = st.builds(
    lambda lane, kind, dag, at_s, took_s: Bar(lane, kind, "T<&\"'", dag, at_s, at_s + took_s),
    st.integers(0, 3), st.sampled_from(["task", "transfer"]), st.integers(0, 9), times, times,
)  # fmt: skip


def chart_with(some_bars):
    end_s = max((bar.end_s for bar in some_bars), default=0.0)
    return Chart("made <up>", ("a", "b", "c", "d"), tuple(some_bars), end_s)


charts = st.lists(bars, max_size=12).map(chart_with)


def test_a_chart_has_a_lane_of_tasks_and_one_of_what_is_sent(run_folder):
    chart = chart_of_run(load_run(run_folder))

    assert chart.lanes == ("a", "a sends", "b", "b sends", "c")
    assert chart.title == "example: completed, 5 s"
    assert [(bar.label, bar.start_s, bar.end_s) for bar in chart.bars if bar.lane == 1] == [
        ("A -> C", 1.0, 3.5)
    ]


def test_a_result_gives_the_chart_of_its_trace(run_folder):
    simulation = worked_example()
    simulation.run()

    from_result = chart_of_result(result_of(simulation), "example")

    assert from_result == chart_of_run(load_run(run_folder))


@given(charts)
def test_bars_of_a_lane_never_overlap_as_drawn(chart):
    rows = rows_of(chart)

    assert sorted(row.bar for row in rows) == sorted(chart.bars)
    for one, other in combinations(rows, 2):
        beside = (
            one.bottom + one.height <= other.bottom or other.bottom + other.height <= one.bottom
        )
        apart = one.bar.end_s <= other.bar.start_s or other.bar.end_s <= one.bar.start_s
        assert one.bar.lane != other.bar.lane or beside or apart
        assert 0 <= one.bottom < one.bottom + one.height <= 1 + 1e-9


def covered_s(some_bars):
    """Return how long something is on, by counting small steps of time."""
    steps = {step for bar in some_bars for step in range(int(bar.start_s * 2), int(bar.end_s * 2))}
    return len(steps) / 2


@given(charts, st.integers(30, 120))
def test_text_fits_its_width_and_heights_tell_the_time(chart, columns):
    lines = drawn(chart, TerminalSize(columns, has_blocks=True)).splitlines()

    assert max(map(len, lines)) <= columns
    cells = [line[3:].rstrip("│").ljust(columns - 4) for line in lines[1:5]]
    width_s = chart.end_s / (columns - 4)
    for lane, row in enumerate(cells):
        full = row.count("█") * width_s
        some = sum(glyph != " " for glyph in row) * width_s
        wanted_s = covered_s([bar for bar in chart.bars if bar.lane == lane])
        assert full - 1e-6 <= wanted_s <= some + 1e-6


def test_a_terminal_without_block_characters_gets_plain_ones(run_folder):
    run = load_run(run_folder)
    plain = terminal_gantt(run, TerminalSize(60, has_blocks=False))
    blocks = terminal_gantt(run, TerminalSize(60, has_blocks=True))

    assert plain.isascii()
    assert [line[:9] for line in plain.splitlines()[1:6]] == [
        line[:9].replace("│", "|") for line in blocks.splitlines()[1:6]
    ]
    assert "@" in plain


def test_a_terminal_is_not_told_what_to_do_by_names():
    chart = Chart("\x1b[31mred", ("\x1b]0;x\x07", "ü" * 99), (), 1.0)

    for has_blocks in (True, False):
        text = drawn(chart, TerminalSize(60, has_blocks))
        assert "\x1b" not in text
        assert "\x07" not in text


@given(charts)
def test_a_picture_is_well_formed_and_holds_every_bar(chart):
    from xml.etree import ElementTree as ET

    root = ET.fromstring(svg_gantt(chart))

    rectangles = [each for each in root.iter("{http://www.w3.org/2000/svg}rect") if len(each)]
    assert len(rectangles) == len(chart.bars)
    for each in rectangles:
        assert float(each.get("x")) + float(each.get("width")) <= 900


def test_a_picture_that_leaves_bars_out_says_so(monkeypatch, run_folder):
    monkeypatch.setattr("ncsim_viz.svg.MAX_BARS", 2)

    assert "the first 2 of 6 bars" in svg_gantt(chart_of_run(load_run(run_folder)))


@pytest.mark.parametrize("end_s", [0.0, 1e-6, 1e9])
def test_charts_of_any_length_are_drawn(end_s):
    chart = Chart("x", ("a",), (Bar(0, "task", "T", 0, 0.0, end_s),), end_s)

    assert svg_gantt(chart)
    assert drawn(chart, TerminalSize(80, has_blocks=True))
