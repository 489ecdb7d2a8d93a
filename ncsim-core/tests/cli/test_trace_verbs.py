"""The verbs that read runs: trace, explain, compare, export."""

import gzip
import json

import pytest
from ncsim_core.cli.main import exit_code_of
from ncsim_core.cli.verbs import app
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.embedding import TRACE_TYPE, compressed_trace, data_element
from ncsim_core.trace.records import TraceHeader
from ncsim_core.trace.writer import TraceWriter
from typer.testing import CliRunner


@pytest.fixture
def run(tmp_path):
    folder = tmp_path / "out"
    folder.mkdir()
    worked_example(TraceWriter(folder / "trace.jsonl", TraceHeader("example"))).run()
    return folder


def ncsim(*args):
    return CliRunner().invoke(app, [str(each) for each in args])


def code(*args):
    return exit_code_of(lambda: app(args=[str(each) for each in args], standalone_mode=False))


def test_show_names_tasks_and_links(run):
    lines = ncsim("trace", "show", run).stdout.splitlines()

    assert lines[0].startswith("example: seed 42, 3 nodes, 2 links, ncsim-core ")
    assert "      1.000000 s  xstart  example/A -> C: 4 MB over ab, bc" in lines
    assert lines[-1].endswith("done    completed, makespan 5.000000 s, 17 events")


def test_show_filters_kinds_and_stops_at_the_limit(run):
    result = ncsim("trace", "show", run, "--kind", "recalc", "--limit", 2)

    assert [line.split()[2] for line in result.stdout.splitlines()] == ["recalc", "recalc"]


def test_show_names_the_kinds_when_one_is_unknown(run, capsys):
    assert code("trace", "show", run, "--kind", "rates") == 1
    assert "no kind of record rates; there are inject, place" in capsys.readouterr().err


def test_a_scenario_in_place_of_a_trace_is_told_as_such(tmp_path, capsys):
    (tmp_path / "x.yaml").write_text("scenario:\n  name: x\n")

    assert code("explain", tmp_path / "x.yaml") == 1
    assert "a trace is what ncsim run x.yaml -o out/ leaves" in capsys.readouterr().err


def test_check_passes_a_sound_trace_and_fails_a_broken_one(run, capsys):
    assert code("trace", "check", run) == 0
    assert "22 records, completed, nothing wrong" in capsys.readouterr().out
    path = run / "trace.jsonl"
    path.write_text(path.read_text().replace('"r":[2.0]', '"r":[1.5]', 1))

    assert code("trace", "check", run) == 1
    assert "was served 3.5 MB of 4.0" in capsys.readouterr().out


def test_check_prints_json_for_scripts(run):
    assert json.loads(ncsim("trace", "check", run, "--json").stdout)[0]["findings"] == []


def test_no_trace_is_one_clean_line(tmp_path, capsys):
    assert code("trace", "check", tmp_path) == 1
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert "holds no trace.jsonl" in error


def test_explain_prints_chain_and_totals(run):
    lines = ncsim("explain", run).stdout.splitlines()

    assert any("transfer A -> C over ab, bc" in line for line in lines)
    assert lines[-1].split() == ["makespan", "5.000000", "s"]


def test_explain_names_the_run_that_it_cannot_explain(run, capsys):
    path = run / "trace.jsonl"
    path.write_text("".join(path.read_text().splitlines(keepends=True)[:9]))

    assert code("explain", run) == 1
    assert capsys.readouterr().err.startswith(f"{run}: the run ended truncated")


def test_explain_prints_json_that_sums_to_the_makespan(run):
    document = json.loads(ncsim("explain", run, "--json").stdout)

    assert sum(document["totals_us"].values()) == document["makespan_us"] == 5_000_000


def test_compare_says_what_differs_first(run, tmp_path):
    worked_example(TraceWriter(tmp_path / "b.jsonl", TraceHeader("example", seed=7))).run()

    lines = ncsim("compare", run, tmp_path / "b.jsonl").stdout.splitlines()
    assert lines[:3] == [
        "configuration",
        "  seed: 42 | 7",
        "makespan: 5.000000 s | 5.000000 s, ratio 1.000000",
    ]
    document = json.loads(ncsim("compare", run, tmp_path / "b.jsonl", "--json").stdout)
    assert document["makespan_ratio"] == 1.0
    assert document["tasks"] == []


@pytest.mark.parametrize("form", ["published", "perfetto"])
def test_export_writes_a_file_once(run, tmp_path, form):
    target = tmp_path / "export"

    assert code("export", run, "--to", form, "-o", target) == 0
    whole = target.read_bytes()
    assert code("export", run, "--to", form, "-o", target) == 1
    assert code("export", run, "--to", form, "-o", target, "--force") == 0
    assert target.read_bytes() == whole


def test_export_writes_tables_to_a_folder(run, tmp_path):
    assert code("export", run, "--to", "csv", "-o", tmp_path / "tables") == 0

    names = sorted(each.name for each in (tmp_path / "tables").iterdir())
    assert names == ["rates.csv", "tasks.csv", "transfers.csv"]
    assert code("export", run, "--to", "csv", "-o", "-") == 1


def test_export_prints_to_standard_output(run):
    assert json.loads(ncsim("export", run, "--to", "perfetto", "-o", "-").stdout)["traceEvents"]


@pytest.fixture
def report(run):
    """Return a page with the run inside, and what such pages may hold besides."""
    element = data_element(TRACE_TYPE, compressed_trace(run))
    page = run / "report.html"
    page.write_text(f"<html><script>é</script>{element}</html>", encoding="utf-8")
    return page


def test_extract_gives_the_trace_back_byte_for_byte(run, report, tmp_path):
    plain, packed = tmp_path / "back.jsonl", tmp_path / "back.jsonl.gz"

    assert code("trace", "extract", report, "-o", plain) == 0
    assert code("trace", "extract", report, "-o", packed) == 0
    assert plain.read_bytes() == (run / "trace.jsonl").read_bytes()
    assert gzip.decompress(packed.read_bytes()) == plain.read_bytes()


def test_extract_says_what_it_cannot_do(run, report, tmp_path, capsys):
    target = tmp_path / "back.jsonl"
    assert code("trace", "extract", run / "trace.jsonl", "-o", target) == 1
    assert "holds no trace" in capsys.readouterr().err
    assert code("trace", "extract", report, "-o", target, "-n", 2) == 1
    assert "no number 2" in capsys.readouterr().err
    assert code("trace", "extract", report, "-o", report) == 1
    assert "exists already" in capsys.readouterr().err
    report.write_text(report.read_text().replace("H4sI", "AAAA"))
    assert code("trace", "extract", report, "-o", target) == 1
    assert "damaged" in capsys.readouterr().err
    assert not target.exists()
