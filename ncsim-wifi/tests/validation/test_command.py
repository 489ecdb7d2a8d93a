import json
import math
from pathlib import Path

import pytest
from ncsim_wifi.validation import command, literature
from ncsim_wifi.validation.command import app
from ncsim_wifi.validation.rows import HEADINGS, Row, table_text
from typer.testing import CliRunner

RUNNER = CliRunner()


def test_a_stage_prints_its_rows_and_counts_them():
    result = RUNNER.invoke(app, ["--stage", "literature"])

    assert result.exit_code == 0
    assert "Bianchi Table III" in result.output
    assert "28 comparisons: 28 pass" in result.output


def test_details_are_left_out_unless_asked_for_or_wrong(monkeypatch):
    common = ("literature", "study", "scene", "MB/s")
    rows = [
        Row(*common, 1.0, "ns-3", 2.0, None),
        Row(*common, 3.0, "ns-3", 4.0, None, is_detail=True),
        Row(*common, 5.0, "ns-3", 6.0, 0.1, is_detail=True),
    ]
    monkeypatch.setattr(literature, "rows", lambda: rows)

    short, long = (
        RUNNER.invoke(app, ["--stage", "literature", *flags]).output
        for flags in ([], ["--details"])
    )

    assert [short.count("study"), short.count("scene"), long.count("scene")] == [1, 2, 3]
    assert "3 comparisons: 1 FAIL, 2 differs; --details shows 1 more" in short
    assert "more" not in long


def test_a_stage_that_is_named_twice_runs_once():
    result = RUNNER.invoke(app, ["--stage", "literature", "--stage", "literature"])

    assert result.output.count("28 comparisons") == 1


def test_json_has_a_row_per_comparison():
    result = RUNNER.invoke(app, ["--stage", "literature", "--json"])

    rows = json.loads(result.output)
    assert len(rows) == 28
    assert {"expected", "measured", "error", "verdict"} <= rows[0].keys()


def test_a_failed_row_fails_the_command(monkeypatch):
    wrong = Row("literature", "x", "y", "S", 1.0, "paper", 2.0, 0.1)
    monkeypatch.setattr(literature, "rows", lambda: [wrong])

    result = RUNNER.invoke(app, ["--stage", "literature"])

    assert result.exit_code == command.EXIT_FAILED
    assert "1 FAIL" in result.output


def test_an_unknown_stage_is_refused():
    assert RUNNER.invoke(app, ["--stage", "nonsense"]).exit_code == 2


def test_figures_are_written(tmp_path: Path):
    figures = pytest.importorskip("ncsim_wifi.validation.figures")

    for path in figures.write_figures(tmp_path / "new"):
        assert path.read_bytes().startswith(b"\x89PNG")


def test_the_verdict_compares_error_with_tolerance():
    rows = [Row("packet", "e", "c", "q", 1.0, "s", 1.5, limit) for limit in (0.5, 0.4, None)]

    assert [row.verdict for row in rows] == ["pass", "FAIL", "differs"]
    assert rows[0].relative_error == 0.5
    assert Row("packet", "e", "c", "q", 0.0, "s", 0.0, None).verdict == "pass"
    assert Row("packet", "e", "c", "q", 0.0, "s", 0.0, 0.0).relative_error is None


@pytest.mark.parametrize(
    ("expected", "measured", "verdict"),
    [(2.0, 1.0, "pass"), (1.0, 1.0, "pass"), (1.0, 1.01, "FAIL"), (1.0, math.nan, "FAIL")],
)
def test_a_bound_may_be_kept_with_room_to_spare(expected, measured, verdict):
    assert Row("packet", "e", "c", "q", expected, "s", measured, 0.0, "<=").verdict == verdict


def test_what_never_ends_is_no_number_in_json_and_equals_itself():
    never = Row("internal", "e", "c", "end s", math.inf, "fluid", math.inf, 0.0)
    ends = Row("internal", "e", "c", "end s", math.inf, "fluid", 3.0, 0.0)

    assert (never.verdict, ends.verdict) == ("pass", "FAIL")
    assert never.to_dict()["expected"] is ends.to_dict()["error"] is None
    assert "inf" in table_text([never])


def test_a_table_has_a_heading_per_experiment_and_numbers_to_the_right():
    rows = [
        Row("internal", "one", "a", "s", 1.5, "fluid", 1.5, 0.0),
        Row("internal", "two", "a longer case", "s", 100.0, "fluid", 100.00001, 1.0),
    ]

    head, one, first, two, second = table_text(rows).splitlines()

    assert head.split() == [*HEADINGS, "verdict", "source"]
    assert (one, two) == ("one", "two")
    assert first.index("1.5") + 3 == second.index("100") + 3 == head.index("expected") + 8
    assert second.split()[-5:] == ["1e-05", "<0.01%", "1", "pass", "fluid"]
