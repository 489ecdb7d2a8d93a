"""report, plot and sweep on the command line, on one small study."""

import csv
import io
import json
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest
import yaml
from ncsim_core.cli.main import main
from ncsim_core.sweep.running import run_sweep

ROOT = Path(__file__).parents[3]
SWEEP = {
    "sweep": {
        "name": "small",
        "base": {
            "network": {"type": "line", "nodes": 3, "bandwidth_MBps": 1},
            "dags": {"type": "layered_random", "layers": 3, "width": 2},
            "config": {"routing": "minimum_hop", "link_model": "wifi"},
        },
        "vary": {
            "scheduler": ["round_robin", "all_on_fastest"],
            "interference": ["none", "csma_bianchi"],
        },
        "replicate": {"seeds": 3},
    }
}
TABLES = ("summary", "runs", "policies", "cases", "totals", "paired")


def ncsim(*args):
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as stop:
        main([str(each) for each in args])
    return stop.value.code, out.getvalue(), err.getvalue()


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    folder = tmp_path_factory.mktemp("verbs")
    (folder / "small.yaml").write_text(yaml.safe_dump(SWEEP, sort_keys=False))
    with run_sweep(folder / "small.yaml", folder / "study", executor="serial") as results:
        results.table()
    return folder / "study"


@pytest.mark.parametrize("table", TABLES)
def test_every_table_comes_in_every_form(study, table, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    texts = {
        form: ncsim("report", study, "--table", table, "--format", form)
        for form in ("terminal", "markdown", "latex", "csv")
    }
    file = tmp_path / "table.parquet"
    assert ncsim("report", study, "--table", table, "-f", "parquet", "-o", file)[0] == 0

    assert {(code, err) for code, _, err in texts.values()} == {(0, "")}
    rows = list(csv.reader(io.StringIO(texts["csv"][1])))
    assert parquet.read_table(file).column_names == rows[0]
    assert parquet.read_table(file).num_rows == len(rows) - 1
    assert len(texts["terminal"][1].splitlines()) == len(rows) + 1
    assert len(texts["markdown"][1].splitlines()) == len(rows) + 3
    assert texts["latex"][1].count(r" \\") == len(rows)


def test_a_report_goes_to_a_new_folder(study, tmp_path):
    file = tmp_path / "new" / "table.tex"

    assert ncsim("report", study, "-f", "latex", "-o", file) == (0, "", "")
    assert file.read_text().startswith("% small: makespan_s, 95% intervals over seeds\n")


def test_a_wider_confidence_gives_wider_intervals(study):
    def highs(*options):
        rows = csv.DictReader(io.StringIO(ncsim("report", study, "-f", "csv", *options)[1]))
        return [float(row["high"]) for row in rows]

    narrow, wide = highs(), highs("--confidence", 0.99)
    assert all(a <= b for a, b in zip(narrow, wide, strict=True))
    assert narrow[0] < wide[0]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--measure", "makespan"), "did you mean 'makespan_s'"),
        (("--table", "paired", "--along", "network.nodes"), "is not varied in this study"),
        (("--table", "policies", "--mode", "scheduler"), "needs 'none' for Solo"),
        (("--format", "parquet"), "give --output FILE"),
    ],
)
def test_what_cannot_be_reported_is_told(study, options, message):
    code, _, err = ncsim("report", study, *options)

    assert code == 1
    assert message in err


def test_figures_are_drawn_from_the_command_line(study, tmp_path):
    pytest.importorskip("matplotlib")
    options = {
        "regret": (),
        "means": ("--along", "scheduler"),
        "slowdown": ("--along", "scheduler"),
    }
    for figure, more in options.items():
        file = tmp_path / f"{figure}.svg"
        assert ncsim("plot", study, "--figure", figure, *more, "-o", file)[0] == 0
        assert file.read_text().startswith("<?xml")
    code, _, err = ncsim("plot", study, "--figure", "means", "-o", tmp_path / "none.svg")

    assert (code, "needs --along COLUMN" in err) == (1, True)


def test_a_study_that_is_not_finished_says_so(study, tmp_path):
    file = study.parent / "small.yaml"
    ncsim("sweep", file, "-o", tmp_path / "part", "--executor", "serial", "--shard", "1/2")
    code, _, err = ncsim("report", tmp_path / "part")

    assert code == 0
    assert err == f"note: 6 of 12 runs of {tmp_path / 'part'} are still to be done\n"


def test_a_dry_run_says_how_many_runs_a_file_makes(study):
    code, out, _ = ncsim("sweep", study.parent / "small.yaml", "--dry-run")

    assert code == 0
    assert out.splitlines() == [
        "small: 12 runs",
        "      2 x scheduler",
        "      2 x interference",
        "      3 x seed",
    ]


def test_the_sweeps_of_the_examples_fit_the_published_schema():
    from jsonschema import Draft7Validator

    schema = json.loads((ROOT / "schemas" / "sweep.schema.json").read_text(encoding="utf-8"))
    files = [
        path
        for path in (ROOT / "examples").rglob("*.yaml")
        if "sweep" in (yaml.safe_load(path.read_text(encoding="utf-8")) or {})
    ]

    assert len(files) >= 6
    for path in files:
        document = yaml.safe_load(path.read_text(encoding="utf-8"))
        assert list(Draft7Validator(schema).iter_errors(document)) == [], path


def test_seeds_of_a_fixed_network_and_workload_are_no_more_observations(tmp_path):
    (tmp_path / "made.yaml").write_text(yaml.safe_dump(SWEEP, sort_keys=False))
    fixed = SWEEP["sweep"] | {"base": {"scenario": str(ROOT / "examples" / "two_hop.yaml")}}
    fixed["vary"] = {"interference": ["none", "csma_bianchi"]}
    (tmp_path / "fixed.yaml").write_text(yaml.safe_dump({"sweep": fixed}, sort_keys=False))

    assert ncsim("sweep", tmp_path / "made.yaml", "--dry-run")[2] == ""
    assert (
        "note: network and workload are the same under all 3 seeds"
        in (ncsim("sweep", tmp_path / "fixed.yaml", "--dry-run")[2])
    )
