"""Runs and columns of a study by name: looked into, explained and compared."""

import io
import json
import sqlite3
from contextlib import redirect_stderr, redirect_stdout

import pytest
from ncsim_core.api import simulate
from ncsim_core.cli.main import main
from ncsim_core.errors import ScenarioError
from ncsim_core.metrics.explanation import explain_run
from ncsim_core.metrics.statistics import mean_interval
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.sweep.running import run_sweep
from ncsim_core.sweep.selecting import Selection, recalled, selection_of
from ncsim_core.units import s_from_us

SWEEP = {
    "sweep": {
        "name": "small",
        "base": {
            "network": {"type": "random_geometric", "nodes": 6, "side_m": 80, "range_m": 70},
            "dags": {"type": "fork_join", "width": 3},
            "config": {"link_model": "wifi", "routing": "minimum_hop"},
        },
        "vary": {
            "scheduler": ["round_robin", "all_on_fastest"],
            "interference": ["none", "csma_bianchi"],
            "dags.payload_MB": [0.5, 2],
        },
        "replicate": {"seeds": 4},
    }
}


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    folder = tmp_path_factory.mktemp("selecting") / "study"
    with run_sweep(SWEEP, folder, executor="serial") as results:
        results.table()
    return folder


def ncsim(*args):
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as stop:
        main([str(each) for each in args])
    return stop.value.code, out.getvalue(), err.getvalue()


def test_every_run_of_a_study_can_be_looked_into(study):
    with run_sweep(SWEEP, study, executor="serial") as results:
        plan, resolver = results.plan, Resolver(results.plan)
        for run in list(plan.runs())[::5]:
            values = dict(zip(plan.columns, map(str, run.values), strict=True))
            trace = recalled(Selection(study, values | {"seed": str(run.seed)}))
            alone = simulate(resolver.scenario(run))

            assert trace.end.makespan_us is not None
            assert s_from_us(trace.end.makespan_us) == alone.makespan_s
            assert sum(explain_run(trace).totals.values()) == trace.end.makespan_us


def test_a_run_of_a_study_is_explained(study):
    chosen = "scheduler=round_robin,interference=csma_bianchi,payload_MB=2,seed=3"
    code, out, _ = ncsim("explain", f"{study}@{chosen}", "--json")
    found = json.loads(out)

    assert code == 0
    assert sum(found["totals_us"].values()) == found["makespan_us"]
    assert found["totals_us"]["contention_loss"] > 0


def test_two_runs_of_a_study_are_compared_task_by_task(study):
    chosen = f"{study}@scheduler=round_robin,payload_MB=2,seed=3"
    code, out, _ = ncsim(
        "compare", f"{chosen},interference=none", f"{chosen},interference=csma_bianchi"
    )

    assert code == 0
    assert "interference_model: none | csma_bianchi" in out
    assert "more contention loss" in out
    assert "regret: 0.0% |" in out


def test_two_columns_are_compared_pair_by_pair(study):
    sides = [f"{study}@interference={mode}" for mode in ("none", "csma_bianchi")]
    code, out, _ = ncsim("compare", *sides, "--json")
    found = json.loads(out)

    assert code == 0
    assert len(found["pairs"]) == 2 * 2 * 4
    for pair in found["pairs"]:
        assert pair["ratio"] == pytest.approx(pair["second_s"] / pair["first_s"])
        assert pair["regret_second"] == pytest.approx(max(0.0, pair["ratio"] - 1))
    ratios = {row["what"]: row for row in found["totals"]}["ratio"]
    assert ratios["mean"] == mean_interval([each["ratio"] for each in found["pairs"]]).mean
    assert ratios["pairs"] == 16
    case = found["cases"][0]
    own = [each for each in found["pairs"] if all(each[c] == case[c] for c in list(case)[:2])]
    assert case["pairs"] == len(own) == 4
    assert case["difference_s"] == mean_interval([each["difference_s"] for each in own]).mean
    assert case["ratio_high"] == mean_interval([each["ratio"] for each in own]).high


def test_columns_that_pair_one_run_with_several_are_refused(study):
    code, _, err = ncsim("compare", f"{study}@scheduler=round_robin", f"{study}@interference=none")

    assert code == 1
    assert "the first of the two means several runs for each of the other" in err
    assert "say which: interference=none|csma_bianchi" in err


def test_columns_that_were_not_named_pair_the_runs(study):
    _, out, _ = ncsim("compare", f"{study}@seed=1", f"{study}@seed=2")

    assert out.splitlines()[1].split()[:3] == ["scheduler", "interference", "dags.payload_MB"]
    assert "over all pairs, 95% intervals; first better" in out


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ("schedler=heft", "did you mean 'scheduler'"),
        ("scheduler=heft", "no run has scheduler=heft; there are round_robin, all_on_fastest"),
        ("scheduler=round_robin,seed=1", "4 runs are meant; say which: interference=none|csma_"),
        ("scheduler", "expected STUDY@COLUMN=VALUE"),
    ],
)
def test_what_names_no_run_is_told(study, what, message):
    code, _, err = ncsim("explain", f"{study}@{what}")

    assert code == 1
    assert message in err


def test_a_path_with_the_mark_in_it_stays_a_path(tmp_path):
    (tmp_path / "a@b").mkdir()

    assert selection_of(str(tmp_path / "a@b")) is None


def test_options_of_a_component_may_hold_commas():
    selection = selection_of("s@scheduler=fcp(a=1, b=2),seed=3")

    assert selection.values == {"scheduler": "fcp(a=1, b=2)", "seed": "3"}


def test_a_run_that_ends_otherwise_than_the_study_says_is_refused(study, tmp_path):
    chosen = {"scheduler": "round_robin", "interference": "none", "payload_MB": "2", "seed": "1"}
    with sqlite3.connect(study / "results.sqlite") as original:
        (tmp_path / "study").mkdir()
        copy = sqlite3.connect(tmp_path / "study" / "results.sqlite")
        original.backup(copy)
    copy.execute("UPDATE result SET makespan_us = makespan_us + 1")
    copy.commit()
    copy.close()
    original.close()

    with pytest.raises(ScenarioError, match="Run the sweep again"):
        recalled(Selection(tmp_path / "study", chosen))
