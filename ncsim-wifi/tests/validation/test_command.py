import json
from pathlib import Path

import pytest
from ncsim_wifi.validation import command, literature
from ncsim_wifi.validation.command import app
from ncsim_wifi.validation.rows import Row, table_text
from typer.testing import CliRunner

RUNNER = CliRunner()


def test_a_stage_prints_its_rows_and_counts_them():
    result = RUNNER.invoke(app, ["--stage", "literature"])

    assert result.exit_code == 0
    assert "Bianchi Table III" in result.output
    assert "28 comparisons: 28 pass" in result.output


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
    assert Row("packet", "e", "c", "q", 0.0, "s", 0.0, 0.0).relative_error is None
    assert len(table_text(rows).splitlines()) == 4
