"""The command line as people meet it: start-up, exit codes, what is written and what is not."""

import io
import json
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import NamedTuple

import pytest
from ncsim_core.cli.main import main
from ncsim_core.metrics import compute_metrics
from ncsim_core.trace.loading import load_run

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.yaml"))
PUBLISHED = sorted((ROOT / "examples" / "published-form").glob("*.yaml"))
TWO_HOP = ROOT / "examples" / "two_hop.yaml"
HEAVY = {"numpy", "networkx", "jsonschema", "saga", "yaml", "scipy", "pandas", "matplotlib"}
BLOCKED = """
scenario:
  network:
    nodes:
      - {id: a, compute_capacity: 1, position: {x: 0, y: 0}}
      - {id: b, compute_capacity: 1, position: {x: 100, y: 0}}
      - {id: c, compute_capacity: 1, position: {x: 0, y: 80}}
      - {id: d, compute_capacity: 1, position: {x: 100, y: 80}}
    links:
      - {id: ab, from: a, to: b}
      - {id: cd, from: c, to: d}
  dags:
    - id: both
      tasks:
        - {id: A, compute_cost: 0, pinned_to: a}
        - {id: B, compute_cost: 0, pinned_to: b}
        - {id: C, compute_cost: 0, pinned_to: c}
        - {id: D, compute_cost: 0, pinned_to: d}
      edges:
        - {from: A, to: B, data_size: 1}
        - {from: C, to: D, data_size: 1}
  config: {scheduler: manual, routing: direct, link_model: wifi, rf: {capture_margin_dB: 0}}
"""


class Done(NamedTuple):
    returncode: int
    stdout: str
    stderr: str


def ncsim(*args):
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as stop:
        main([str(each) for each in args])
    return Done(stop.value.code, out.getvalue(), err.getvalue())


def test_help_imports_nothing_heavy():
    code = (
        "import sys\n"
        "from ncsim_core.cli.main import main\n"
        "try:\n    main(['--help'])\n"
        "except SystemExit:\n    pass\n"
        "print('LOADED', *sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    loaded = set(done.stdout.rpartition("LOADED")[2].split())
    assert loaded & HEAVY == set()
    assert not any(name.startswith("ncsim_viz") for name in loaded)
    assert "Usage: ncsim" in done.stdout


@pytest.mark.parametrize("path", EXAMPLES + PUBLISHED, ids=lambda path: path.stem)
def test_examples_run_and_their_traces_are_in_order(path, tmp_path):
    ran = ncsim("run", path, "-o", tmp_path / "out")
    checked = ncsim("trace", "check", tmp_path / "out")

    assert ran.returncode == 0, ran.stderr
    assert ": completed" in ran.stdout
    assert checked.returncode == 0, checked.stdout + checked.stderr


@pytest.mark.parametrize("interference", ["proximity", "csma_clique", "csma_bianchi", "none"])
@pytest.mark.parametrize(
    "scheduler", ["all_on_fastest", "conflict_aware_heft", "uniform_discount_heft"]
)
def test_published_files_that_name_baselines_and_models_run(scheduler, interference, tmp_path):
    path = tmp_path / "published.yaml"
    path.write_text(
        f"""
name: published
network:
  nodes:
    - {{id: n0, compute_capacity: 100, position: {{x: 0, y: 0}}}}
    - {{id: n1, compute_capacity: 300, position: {{x: 30, y: 0}}}}
  links:
    - {{id: l01, from: n0, to: n1, bandwidth: 4}}
    - {{id: l10, from: n1, to: n0, bandwidth: 4}}
dags:
  - id: dag_1
    tasks:
      - {{id: T0, compute_cost: 100, pinned_to: n0}}
      - {{id: T1, compute_cost: 300}}
    edges:
      - {{from: T0, to: T1, data_size: 8}}
config: {{scheduler: {scheduler}, interference: {interference}, interference_radius: 15.0}}
""",
        encoding="utf-8",
    )

    done = ncsim("run", path)

    assert done.returncode == 0, done.stderr
    assert f"scheduler {scheduler}" in done.stdout
    assert f"interference {interference}" in done.stdout


@pytest.mark.parametrize(
    ("name", "makespan_s"),
    [
        ("simple-demo", 5.501),
        ("forced-multi-hop", 7.02),
        ("several-dags", 8),
        ("shared-link", 10.03),
    ],
)
def test_without_a_radio_the_published_tool_gave_the_same(name, makespan_s):
    """Makespans of anrg-ncsim 1.0.0, run on the same files."""
    path = ROOT / "examples" / "published-form" / f"{name}.yaml"

    assert json.loads(ncsim("run", path, "--json").stdout)["makespan_s"] == makespan_s


@pytest.mark.parametrize("path", PUBLISHED, ids=lambda path: path.stem)
def test_what_is_translated_from_the_published_form_is_said(path):
    assert "note:" in ncsim("run", path).stderr
    assert ncsim("run", path, "--quiet").stderr == ""


def test_a_run_leaves_four_files_from_which_it_can_be_repeated(tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    ncsim("run", TWO_HOP, "-o", first)

    again = ncsim("run", first / "scenario.yaml", "-o", second)

    assert again.returncode == 0, again.stderr
    names = ["metrics.json", "run.json", "scenario.yaml", "trace.jsonl"]
    assert sorted(path.name for path in first.iterdir()) == names
    for name in ("metrics.json", "scenario.yaml", "trace.jsonl"):
        assert (first / name).read_bytes() == (second / name).read_bytes()
    metrics = json.loads((first / "metrics.json").read_text(encoding="utf-8"))
    assert metrics["makespan_s"] == pytest.approx(8.930348)


def test_an_existing_folder_is_refused_unless_forced(tmp_path):
    out = tmp_path / "out"
    ncsim("run", TWO_HOP, "-o", out)
    before = (out / "run.json").read_bytes()

    refused = ncsim("run", TWO_HOP, "-o", out)
    kept = (out / "run.json").read_bytes()
    forced = ncsim("run", TWO_HOP, "-o", out, "--force")

    assert refused.returncode == 1
    assert "--force" in refused.stderr
    assert kept == before
    assert forced.returncode == 0
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_wrong_input_is_exit_code_one_and_touches_nothing(tmp_path):
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text(TWO_HOP.read_text(encoding="utf-8").replace("to: server}", "to: sever}"))

    done = ncsim("run", wrong, "-o", tmp_path / "out")

    assert done.returncode == 1
    assert f"{wrong}:13:" in done.stderr
    assert "did you mean 'server'" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["wrong.yaml"]


@pytest.mark.parametrize(
    ("options", "status"),
    [
        (["--max-events", "3"], "limit_reached"),
        (["--max-time", "1.5"], "limit_reached"),
        (["--routing", "direct"], "unroutable"),
    ],
)
def test_a_run_that_does_not_complete_is_exit_code_two_without_makespan(options, status, tmp_path):
    done = ncsim("run", TWO_HOP, "-o", tmp_path / "out", *options)

    assert done.returncode == 2
    assert f": {status}" in done.stdout
    metrics = json.loads((tmp_path / "out" / "metrics.json").read_text(encoding="utf-8"))
    assert metrics["status"] == status
    assert metrics["makespan_s"] is None


def test_mutually_hidden_transfers_block_each_other_under_the_full_model_only(tmp_path):
    scenario = tmp_path / "blocked.yaml"
    scenario.write_text(BLOCKED, encoding="utf-8")

    solo, full = ncsim("run", scenario), ncsim("run", scenario, "--interference", "csma_bianchi")

    assert solo.returncode == 0, solo.stderr
    assert full.returncode == 2
    assert ": blocked_wireless" in full.stdout
    assert "both: C -> D (1 MB left, stalled on link cd)" in full.stdout


@pytest.mark.parametrize("level", ["full", "coarse"])
def test_stored_metrics_are_those_of_the_trace_when_a_run_is_cut_short_too(level, tmp_path):
    out = tmp_path / "out"
    ncsim("run", TWO_HOP, "-o", out, "--max-time", "5", "--trace", level)

    stored = json.loads((out / "metrics.json").read_text(encoding="utf-8"))

    assert stored == json.loads(json.dumps(compute_metrics(load_run(out))))
    assert stored["status"] == "limit_reached"


@pytest.mark.parametrize("arguments", [["rnu"], ["run"], ["run", "--nonsense", "x"], []])
def test_wrong_usage_is_exit_code_one(arguments):
    done = ncsim(*arguments)

    assert done.returncode == 1
    assert "Usage: ncsim" in done.stdout + done.stderr


def test_json_output_is_json():
    result = json.loads(ncsim("run", TWO_HOP, "--json").stdout)

    assert result["status"] == "completed"
    assert [task["task"] for task in result["tasks"]] == ["see", "hear", "fuse"]


def test_overrides_are_read_as_the_file_would_be():
    done = ncsim("run", TWO_HOP, "--set", "rf.tx_power_dBm=5e1.0")

    assert done.returncode == 1
    assert "rf.tx_power_dBm" in done.stderr


def test_a_new_scenario_runs_and_is_not_overwritten(tmp_path):
    path = tmp_path / "first.yaml"
    made, again = ncsim("new", path), ncsim("new", path)

    assert made.returncode == 0
    assert again.returncode == 1
    assert ncsim("run", path).returncode == 0


def test_validate_says_what_a_scenario_holds_or_all_that_is_wrong(tmp_path):
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text("scenario: {network: {nodes: [], links: [1]}, dags: 7}\n", encoding="utf-8")

    done = ncsim("validate", TWO_HOP, wrong)

    assert done.returncode == 1
    assert "3 nodes, 2 links, 1 DAGs, 3 tasks" in done.stdout
    assert done.stderr.count(f"{wrong}:1:") >= 2
