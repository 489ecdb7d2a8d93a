"""What changed between two runs, and why."""

from dataclasses import replace

from hypothesis import given, settings
from ncsim_core.engine.simulation import Simulation
from ncsim_core.metrics.comparison import compare_runs
from ncsim_core.metrics.losses import Part
from ncsim_core.network import LinkRates
from ncsim_core.testing.builders import inject
from ncsim_core.testing.toys import ToyRadio, models
from ncsim_core.testing.whole_runs import run_cases
from ncsim_core.testing.worked_example import EXAMPLE, NETWORK
from ncsim_core.trace.recorder import RunRecorder
from ncsim_core.trace.records import TraceHeader


def recorded(network=NETWORK, dag=EXAMPLE, seed=42, **components):
    recorder = RunRecorder(TraceHeader(seed=seed))
    Simulation(network, models(network, [inject(dag)], **components), observers=[recorder]).run()
    return recorder.run_trace()


@settings(max_examples=20, deadline=None)
@given(run_cases())
def test_a_run_compared_with_itself_shows_nothing(case):
    recorder = RunRecorder()
    case.simulation(recorder).run()
    run = recorder.run_trace()

    comparison = compare_runs(run, run)
    assert comparison.differences == comparison.tasks == comparison.transfers == ()
    assert comparison.unmatched == ()
    assert comparison.makespan_ratio in (1.0, None)


def test_interference_shows_as_contention_on_the_transfers_it_slows():
    slowed = recorded(interference=ToyRadio({0: [1], 1: [0]}, {}))

    comparison = compare_runs(recorded(), slowed)
    changes = {change.label: change for change in comparison.transfers}
    assert changes["example/A -> C"].parts[Part.CONTENTION_LOSS] > 0
    assert changes["example/A -> C"].why == "more contention_loss"
    assert comparison.makespan_ratio > 1
    later = {change.label: change for change in comparison.tasks}
    assert later["example/C"].why == "inputs later"


def test_settings_that_differ_come_with_both_values():
    faster = NETWORK.with_rates(LinkRates((4.0, 2.0), (0.0, 0.0)))

    comparison = compare_runs(recorded(), recorded(faster, seed=7))
    differences = {each.setting: (each.first, each.second) for each in comparison.differences}
    assert differences["seed"] == ("42", "7")
    assert differences["links.ab"] == (
        "a -> b, 2 MB/s, 0 s, wireless",
        "a -> b, 4 MB/s, 0 s, wireless",
    )


def test_a_moved_task_is_said_to_have_moved():
    tasks = tuple(
        replace(task, pinned_to="b" if task.id == "D" else task.pinned_to) for task in EXAMPLE.tasks
    )

    comparison = compare_runs(recorded(), recorded(dag=replace(EXAMPLE, tasks=tasks)))
    moved = {change.label: change for change in comparison.tasks}["example/D"]
    assert (moved.first_node, moved.second_node) == ("c", "b")
    assert moved.why == "moved, inputs earlier"


def test_what_only_one_run_has_is_listed():
    fewer = replace(EXAMPLE, tasks=EXAMPLE.tasks[:3], dependencies=EXAMPLE.dependencies[:1])

    assert compare_runs(recorded(), recorded(dag=fewer)).unmatched == (
        "task example/D: only in the first",
        "dependency example/B -> D: only in the first",
    )
