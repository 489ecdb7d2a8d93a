"""Figures show the numbers of the tables, and equal studies give equal files."""

from contextlib import contextmanager
from xml.etree import ElementTree

import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.metrics.statistics import mean_interval
from ncsim_core.sweep import drawing, figures
from ncsim_core.sweep.figures import draw_means, draw_regret, draw_slowdown
from ncsim_core.sweep.table import MEASURES, Table

pytest.importorskip("matplotlib", reason="needs matplotlib: pip install 'ncsim-core[plots]'")


def study(rows, *columns):
    """Return a table of (values of the columns, seed, makespan) with everything else empty."""
    filled = [
        (*values, "failed" if m is None else "completed", m, *([None] * (len(MEASURES) - 2)))
        for *values, m in rows
    ]
    return Table((*columns, "seed", *MEASURES), tuple(filled), "study", heads=len(columns) + 1)


PAYLOADS = study(
    [
        (payload, mode, seed, seed * payload * (2.0 if mode == "csma_bianchi" else 1.0))
        for payload in (1, 10, 100)
        for mode in ("none", "csma_bianchi")
        for seed in (1, 2, 4)
    ],
    *("dags.payload_MB", "interference"),
)
POLICIES = study(
    [
        ("a", "heft", "none", 1, 3.0),
        ("a", "heft", "csma_bianchi", 1, 12.0),
        ("a", "cpop", "none", 1, 4.0),
        ("a", "cpop", "csma_bianchi", 1, 8.0),
        ("b", "heft", "none", 1, 3.0),
        ("b", "heft", "csma_bianchi", 1, 6.0),
        ("b", "cpop", "none", 1, 4.0),
        ("b", "cpop", "csma_bianchi", 1, None),
        ("c", "heft", "none", 1, None),
        ("c", "heft", "csma_bianchi", 1, None),
        ("c", "cpop", "none", 1, None),
        ("c", "cpop", "csma_bianchi", 1, None),
    ],
    *("case", "scheduler", "interference"),
)


@pytest.fixture
def drawn(monkeypatch):
    """Return a list that takes every figure before it is written."""
    kept = []
    original = drawing.figure_at

    @contextmanager
    def keeping(*args, **more):
        with original(*args, **more) as figure:
            yield figure
            kept.append(figure)

    monkeypatch.setattr(figures, "figure_at", keeping)
    return kept


def lines_of(axes):
    return {each.get_label(): each.lines for each in axes.containers}


def test_means_and_intervals_are_those_of_the_statistics(drawn, tmp_path):
    draw_means(PAYLOADS, "payload_MB", "makespan_s", tmp_path / "means.svg")
    axes = drawn[0].axes[0]
    data, _, bars = lines_of(axes)["csma_bianchi"]
    intervals = [mean_interval([2.0 * seed * payload for seed in (1, 2, 4)]) for payload in (1, 10)]

    assert list(data.get_xdata()) == [1.0, 10.0, 100.0]
    assert list(data.get_ydata()[:2]) == [each.mean for each in intervals]
    assert bars[0].get_segments()[1][1][1] == pytest.approx(intervals[1].high)
    assert axes.get_xscale() == "log"
    assert axes.get_xlabel() == "payload (MB)"
    assert axes.get_ylabel() == "makespan (s)"


def test_slowdown_is_taken_seed_by_seed(drawn, tmp_path):
    draw_slowdown(PAYLOADS, "payload_MB", "interference", tmp_path / "slowdown.svg")
    data, _, _ = drawn[0].axes[0].containers[0].lines

    assert list(data.get_ydata()) == [2.0, 2.0, 2.0]


def test_regret_bars_rise_from_one_and_inversions_are_red(drawn, tmp_path):
    draw_regret(POLICIES, "scheduler", "interference", tmp_path / "regret.svg")
    bars = drawn[0].axes[0].patches

    assert [bar.get_y() for bar in bars] == [1.0, 1.0, 1.0]
    assert [bar.get_height() for bar in bars[:2]] == [0.5, 0.0]
    assert bars[2].get_height() != bars[2].get_height()  # nothing completed: no bar
    colours = [bar.get_facecolor() for bar in bars]
    assert colours[0] != colours[1] == colours[2]


def test_values_without_order_keep_that_of_the_file(drawn, tmp_path):
    draw_means(POLICIES, "case", "makespan_s", tmp_path / "cases.svg")
    axes = drawn[0].axes[0]

    assert [label.get_text() for label in axes.get_xticklabels()] == ["a", "b", "c"]


@pytest.mark.parametrize("suffix", [".png", ".pdf", ".svg"])
def test_equal_studies_give_equal_files(tmp_path, suffix):
    for name in ("one", "other"):
        draw_means(PAYLOADS, "payload_MB", "makespan_s", tmp_path / f"{name}{suffix}")
    one, other = ((tmp_path / f"{name}{suffix}").read_bytes() for name in ("one", "other"))

    assert one == other
    assert len(one) > 5000


def test_text_in_pictures_stays_text(tmp_path):
    draw_means(PAYLOADS, "payload_MB", "makespan_s", tmp_path / "means.svg")
    texts = {each.text for each in ElementTree.parse(tmp_path / "means.svg").iter() if each.text}

    assert {"payload (MB)", "makespan (s)", "csma_bianchi", "none", "study"} <= texts


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda p: draw_means(PAYLOADS, "payload", "makespan_s", p), "'payload' is not varied"),
        (lambda p: draw_means(PAYLOADS, "payload_MB", "makespan", p), "mean 'makespan_s'"),
        (lambda p: draw_slowdown(POLICIES, "case", "scheduler", p), "needs 'none' for Solo"),
        (lambda p: draw_means(PAYLOADS, "payload_MB", "events", p.with_suffix(".gif")), "ends in"),
    ],
)
def test_what_cannot_be_drawn_is_told(draw, message, tmp_path):
    with pytest.raises(ScenarioError, match=message):
        draw(tmp_path / "figure.png")

    assert list(tmp_path.iterdir()) == []


def test_points_at_names_are_joined_only_where_several_lines_cross(drawn, tmp_path):
    draw_means(POLICIES, "scheduler", "makespan_s", tmp_path / "several.svg")
    draw_slowdown(PAYLOADS, "payload_MB", "interference", tmp_path / "numbers.svg")
    one = study([("heft", 1, 3.0), ("cpop", 1, 4.0)], "scheduler")
    draw_means(one, "scheduler", "makespan_s", tmp_path / "one.svg")

    styles = [{line[0].get_linestyle() for line in lines_of(f.axes[0]).values()} for f in drawn]
    assert "None" not in styles[0] | styles[1]
    assert styles[2] == {"None"}


def test_lines_without_a_legend_are_counted(drawn, tmp_path):
    many = study([(k, mode, 1, 1.0) for k in range(20) for mode in ("a", "b")], "case", "mode")
    draw_means(many, "mode", "makespan_s", tmp_path / "many.svg")

    assert "20 lines, one per case: too many to name" in drawn[0].axes[0].get_title()
