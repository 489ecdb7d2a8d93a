"""``ncsim reproduce``: what somebody sent is what its scenario gives, or it is said what is not."""

import json
import shutil
import sys

import pytest
from ncsim_core.cli.verbs import app
from ncsim_core.testing.fixtures import DECLARATION, fake_dist
from typer.testing import CliRunner

__all__ = ["fake_dist"]

SCENARIO = """
scenario:
  name: small
  network:
    nodes: [{id: a, compute_capacity: 1}, {id: b, compute_capacity: 2}]
    links: [{id: ab, from: a, to: b, bandwidth: 2}, {id: ba, from: b, to: a, bandwidth: 2}]
  dags:
    - id: d
      tasks: [{id: T0, compute_cost: 1, pinned_to: a}, {id: T1, compute_cost: 1, pinned_to: b}]
      edges: [{from: T0, to: T1, data_size: 4}]
  config: {scheduler: manual}
"""

TOSSING = """
from ncsim_core.contracts.scheduler import Scheduler
from ncsim_core.workflow import PlacementPlan

class Tossing(Scheduler):
    def __init__(self, context):
        self.context = context

    def schedule(self, dag, snapshot):
        node = snapshot.network.nodes[NODE].id
        return PlacementPlan({task.id: node for task in dag.tasks})
"""


def ncsim(*args):
    return CliRunner().invoke(app, [str(each) for each in args])


def folder_of(tmp_path, *options, scenario=SCENARIO):
    (tmp_path / "small.yaml").write_text(scenario)
    result = ncsim("run", tmp_path / "small.yaml", "-o", tmp_path / "out", *options)
    assert (tmp_path / "out").is_dir(), result.output
    return tmp_path / "out"


@pytest.mark.parametrize("options", [(), ("--gzip",), ("--trace", "coarse")])
def test_a_folder_that_nobody_touched_is_reproduced(tmp_path, options):
    result = ncsim("reproduce", folder_of(tmp_path, *options))

    assert result.exit_code == 0, result.output
    assert "reproduced; " in result.output
    assert "here completed, makespan 3.500000 s" in result.output


def test_a_scenario_that_was_changed_is_told_with_the_record_that_differs(tmp_path):
    out = folder_of(tmp_path)
    text = (out / "scenario.yaml").read_text()
    (out / "scenario.yaml").write_text(text.replace("data_size: 4", "data_size: 6"))

    result = ncsim("reproduce", out)

    assert result.exit_code == 1
    assert "NOT reproduced" in result.output
    assert "scenario.yaml was changed after the run" in result.output
    assert "part at line 2" in result.output
    assert "[[0,1,4.0]]" in result.output
    assert "[[0,1,6.0]]" in result.output


def test_a_trace_that_was_edited_parts_where_it_was(tmp_path):
    out = folder_of(tmp_path)
    trace = out / "trace.jsonl"
    trace.write_text(trace.read_text().replace('"t":1000000,"k":"end"', '"t":1000001,"k":"end"'))

    result = ncsim("reproduce", out)

    assert result.exit_code == 1
    assert "there  1.000001 s  end     d/T0 on a" in result.output
    assert "here   1.000000 s  end     d/T0 on a" in result.output
    assert "was the trace edited" in result.output


def test_a_trace_that_is_torn_off_is_the_same_as_far_as_it_goes(tmp_path):
    out = folder_of(tmp_path)
    lines = (out / "trace.jsonl").read_bytes().splitlines(keepends=True)
    for end, kept in ((b"", 5), (b'{"t":10', 5)):
        (out / "trace.jsonl").write_bytes(b"".join(lines[:kept]) + end)

        result = ncsim("reproduce", out)

        assert result.exit_code == 1
        assert "the first 4 records are the same" in result.output
        assert "is torn off at line 6" in result.output


def test_metrics_that_the_trace_does_not_give_are_told(tmp_path):
    out = folder_of(tmp_path)
    metrics = json.loads((out / "metrics.json").read_text())
    (out / "metrics.json").write_text(json.dumps(metrics | {"makespan_s": 1.0}))

    result = ncsim("reproduce", out)

    assert result.exit_code == 1
    assert "metrics.json: makespan_s is 1.0; the trace gives 3.5" in result.output


def declared(node):
    component = 'Component("scheduler", "tossing", "tossing_code:Tossing", "Tosses.")'
    hook = f"@hookimpl\ndef ncsim_components():\n    return [{component}]\n"
    code = TOSSING.replace("NODE", str(node))
    return {"tossing_declaration": DECLARATION + hook, "tossing_code": code}


def test_another_version_is_told_whether_or_not_it_answers_alike(tmp_path, fake_dist, monkeypatch):
    site = fake_dist("tossing-dist", declared(0), version="1.0")
    scenario = SCENARIO.replace("manual", "tossing").replace(", pinned_to: a", "")
    out = folder_of(tmp_path, scenario=scenario.replace(", pinned_to: b", ""))

    for node, code in ((0, 0), (1, 1)):
        shutil.rmtree(site)
        monkeypatch.delitem(sys.modules, "tossing_code")
        fake_dist("tossing-dist", declared(node), version="2.0")
        result = ncsim("reproduce", out)

        assert result.exit_code == code, result.output
        assert "tossing-dist 1.0 there, 2.0 here" in result.output


def test_a_package_that_is_missing_is_named_with_its_version(tmp_path):
    out = folder_of(tmp_path)
    trace = out / "trace.jsonl"
    old = '"name":"manual","distribution":"ncsim-core"'
    assert old in trace.read_text()
    trace.write_text(trace.read_text().replace(old, old.replace("ncsim-core", "gone-dist")))

    error = ncsim("reproduce", out).exception

    assert "scheduler 'manual' (gone-dist 0.1.0): pip install gone-dist==0.1.0" in str(error)


@pytest.mark.parametrize(
    ("options", "message"),
    [(("--max-events", "2"), "stopped at a limit"), (("--trace", "off"), "holds no trace")],
)
def test_what_cannot_be_reproduced_says_why(tmp_path, options, message):
    assert message in str(ncsim("reproduce", folder_of(tmp_path, *options)).exception)


def test_a_trace_without_its_scenario_cannot_be_reproduced(tmp_path):
    out = folder_of(tmp_path)
    (out / "scenario.yaml").unlink()

    assert "holds no scenario.yaml" in str(ncsim("reproduce", out / "trace.jsonl").exception)


def test_a_run_of_a_study_is_held_to_what_the_study_says(tmp_path):
    (tmp_path / "small.yaml").write_text(SCENARIO)
    (tmp_path / "sweep.yaml").write_text(
        "sweep:\n  base: {scenario: small.yaml}\n  vary: {routing: [direct]}\n"
    )
    study = tmp_path / "study"
    swept = ncsim("sweep", tmp_path / "sweep.yaml", "-o", study, "--executor", "serial")
    assert swept.exit_code == 0, swept.output

    told = ncsim("reproduce", f"{study}@routing=direct")

    assert told.exit_code == 0, told.exception
    assert "reproduced; completed, makespan 3.500000 s, as in the study" in told.output
    assert "say which of its runs" in str(ncsim("reproduce", study).exception)
