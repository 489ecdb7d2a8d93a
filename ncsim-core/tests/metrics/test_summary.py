"""Metrics of one run: the worked example by hand, and what must hold of every run."""

import json

import pytest
from hypothesis import given, settings
from jsonschema import Draft202012Validator
from ncsim_core.engine.setup import Limits
from ncsim_core.engine.simulation import Simulation
from ncsim_core.metrics import compute_metrics, metrics_schema
from ncsim_core.network import Link, LinkRates, Network, Node
from ncsim_core.testing.builders import inject
from ncsim_core.testing.toys import models
from ncsim_core.testing.whole_runs import run_cases
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.loading import load_run
from ncsim_core.trace.recorder import RunRecorder
from ncsim_core.trace.writer import TraceWriter
from ncsim_core.units import MAX_QUANTITY
from ncsim_core.workflow import DAG, Dependency, Task


def metrics_of(simulation_of, **options):
    recorder = RunRecorder(**options)
    simulation_of(recorder).run()
    return compute_metrics(recorder.run_trace())


def test_the_worked_example_has_the_metrics_of_the_paper():
    metrics = metrics_of(worked_example)

    assert metrics["makespan_s"] == 5.0
    assert metrics["tasks"] == {"total": 4, "ended": 4}
    assert metrics["remote_MB"] == 5.0
    assert metrics["route_work_MB_hops"] == 9.0
    assert [link["served_MB"] for link in metrics["links"]] == [4.0, 5.0]
    assert [link["busy_s"] for link in metrics["links"]] == [2.5, 2.5]
    assert [node["busy_s"] for node in metrics["nodes"]] == [1.0, 2.0, 2.0]
    assert [node["utilisation"] for node in metrics["nodes"]] == [0.2, 0.4, 0.4]
    assert [node["queue_wait_s"] for node in metrics["nodes"]] == [0.0, 0.0, 0.5]
    assert metrics["critical_path_s"] == 4.0
    assert metrics["mean_transfer_slowdown"] == pytest.approx((2.5 / 2 + 1.0 / 0.5) / 2)
    assert metrics["dags"] == [
        {"id": "example", "injected_s": 0.0, "ended_s": 5.0, "response_s": 5.0}
    ]


@settings(max_examples=30, deadline=None)
@given(run_cases())
def test_metrics_of_the_trace_are_those_of_the_run(tmp_path_factory, case):
    path = tmp_path_factory.mktemp("run") / "t.jsonl"
    recorder = RunRecorder(keeps_steps=False)
    case.simulation(recorder, TraceWriter(path)).run()

    stored = json.dumps(compute_metrics(recorder.run_trace()))
    assert json.dumps(compute_metrics(load_run(path))) == stored


@settings(max_examples=30, deadline=None)
@given(run_cases())
def test_no_run_beats_its_critical_path_and_bytes_are_conserved(case):
    metrics = metrics_of(case.simulation)

    if metrics["makespan_s"] is not None:
        assert metrics["critical_path_s"] <= metrics["makespan_s"]
        served_MB = sum(link["served_MB"] for link in metrics["links"])
        assert served_MB == pytest.approx(metrics["route_work_MB_hops"])
        assert metrics["transfers"]["ended"] == metrics["transfers"]["total"]


@settings(max_examples=20, deadline=None)
@given(run_cases())
def test_metrics_obey_their_schema_and_shares_stay_shares(case):
    metrics = metrics_of(case.simulation)

    Draft202012Validator(metrics_schema()).validate(json.loads(json.dumps(metrics)))
    for row in [*metrics["nodes"], *metrics["links"]]:
        assert 0 <= row["utilisation"] <= 1
    if metrics["mean_transfer_slowdown"] is not None:
        assert 1 <= metrics["mean_transfer_slowdown"] <= metrics["max_transfer_slowdown"]


def test_a_run_that_stops_early_has_no_makespan_and_counts_what_was_served():
    metrics = metrics_of(lambda *o: _limited(o, max_time_us=1_500_000))

    assert metrics["status"] == "limit_reached"
    assert metrics["makespan_s"] is None
    assert metrics["critical_path_s"] is None
    assert metrics["tasks"] == {"total": 4, "ended": 1}
    assert metrics["dags"][0]["ended_s"] is None


def test_completed_runs_have_equal_metrics_whatever_was_recorded_of_rates():
    assert metrics_of(worked_example, level="coarse") == metrics_of(worked_example)


def _limited(observers, **limits):
    whole = worked_example()
    return Simulation(whole.setup.network, whole.setup.models, Limits(**limits), observers)


@pytest.mark.parametrize("size_MB", [1e-320, 1e-30, 1e-6, 1e95, MAX_QUANTITY])
def test_sizes_of_any_order_of_magnitude_have_metrics(size_MB):
    network = Network(
        (Node("a", 1.0), Node("b", 1.0)),
        (Link("ab", "a", "b"),),
        LinkRates((MAX_QUANTITY,), (0.0,)),
    )
    tasks = (Task("s", 0.0, "a"), Task("t", 0.0, "b"), Task("u", 0.0, "b"))
    dag = DAG("d", tasks, (Dependency("s", "t", size_MB), Dependency("s", "u", size_MB)))
    chosen = models(network, [inject(dag)])

    metrics = metrics_of(lambda *observers: Simulation(network, chosen, Limits(), observers))

    assert metrics["remote_MB"] == 2 * size_MB
    assert metrics["max_transfer_slowdown"] in (None, pytest.approx(2.0))


def test_the_schema_is_a_schema():
    Draft202012Validator.check_schema(metrics_schema())
