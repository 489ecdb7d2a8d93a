"""Where the makespan went: the parts sum to it, to the microsecond, for every run."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_core.builtin.schedulers import ManualScheduler
from ncsim_core.engine.simulation import Simulation
from ncsim_core.metrics.explanation import explain_run
from ncsim_core.metrics.losses import LOSSES, Part, divide
from ncsim_core.network import Link, LinkRates, Network, Node
from ncsim_core.testing.builders import chain, inject, line, make_context, rated
from ncsim_core.testing.toys import ToyRadio, ToyRelays, models
from ncsim_core.testing.whole_runs import run_cases
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.recorder import RunRecorder
from ncsim_core.trace.records import TraceError
from ncsim_core.workflow import DAG, Dependency, Task


def explained(simulation_of, **options):
    recorder = RunRecorder(**options)
    simulation_of(recorder).run()
    return explain_run(recorder.run_trace())


def seconds(totals):
    return {part.value: spent_us / 1e6 for part, spent_us in totals.items() if spent_us}


def parallel_pairs(count, interference, *, at_s=0.0, latency_s=0.0):
    """Return a run of ``count`` links side by side at 2 MB/s, each carrying 4 MB."""
    nodes = tuple(Node(f"n{k}", 1.0) for k in range(2 * count))
    links = tuple(Link(f"l{k}", f"n{2 * k}", f"n{2 * k + 1}") for k in range(count))
    network = Network(nodes, links, LinkRates((2.0,) * count, (latency_s,) * count))
    senders = [Task(f"S{k}", 0, f"n{2 * k}") for k in range(count)]
    receivers = [Task(f"R{k}", 0, f"n{2 * k + 1}") for k in range(count)]
    edges = tuple(Dependency(f"S{k}", f"R{k}", 4.0) for k in range(count))
    dag = DAG("dag", (*senders, *receivers), edges)
    scheduler = ManualScheduler(make_context(network))
    chosen = models(network, [inject(dag, at_s)], scheduler=scheduler, interference=interference)
    return lambda *observers: Simulation(network, chosen, observers=observers)


def test_the_worked_example_is_split_as_by_hand():
    explanation = explained(worked_example)

    assert [item.label for item in explanation.chain] == ["example", "A", "A -> C", "C"]
    assert seconds(explanation.totals) == {
        "compute": 2.0,
        "queue_wait": 0.5,
        "transfer_alone": 2.0,
        "sharing_loss": 0.5,
    }


def test_contention_alone_is_contention_loss():
    near = {0: [1], 1: [0]}

    totals = explained(parallel_pairs(2, ToyRadio(near, {}))).totals
    assert seconds(totals) == {"transfer_alone": 2.0, "contention_loss": 2.0}


def test_hidden_interference_alone_is_hidden_loss():
    far = {0: [1], 1: [0]}

    totals = explained(parallel_pairs(2, ToyRadio({}, far))).totals
    assert totals[Part.TRANSFER_ALONE] == 2_000_000
    assert totals[Part.HIDDEN_LOSS] == 666_667  # 4 MB at three quarters of 2 MB/s, rounded up
    assert totals[Part.CONTENTION_LOSS] == 0


def test_causes_that_act_together_divide_the_loss_by_their_logarithms():
    near, far = {0: [1], 1: [0], 2: []}, {0: [2], 1: [2], 2: []}

    explanation = explained(parallel_pairs(3, ToyRadio(near, far)))
    first = explanation.totals
    together_us = first[Part.CONTENTION_LOSS] + first[Part.HIDDEN_LOSS]
    # 4 MB: 0.75 MB/s until the third link's 2 s are over, then 1 MB/s without hidden interference
    assert together_us == 4_500_000 - 2_000_000
    weight = math.log(4 / 3) / (math.log(2) + math.log(4 / 3))
    lost_us = 2_000_000 * (1 - 0.75 / 2)
    assert first[Part.HIDDEN_LOSS] == pytest.approx(lost_us * weight, abs=1)


def test_a_paused_transfer_loses_its_time_to_contention():
    near = {0: [1], 1: []}

    totals = explained(parallel_pairs(2, ToyRadio(near, {}, stop_at=1))).totals
    assert seconds(totals) == {"transfer_alone": 2.0, "contention_loss": 2.0}


def test_injection_and_latency_have_their_own_parts():
    run = parallel_pairs(1, ToyRadio({}, {}), at_s=1.5, latency_s=0.25)

    assert seconds(explained(run).totals) == {
        "injection_wait": 1.5,
        "latency": 0.25,
        "transfer_alone": 2.0,
    }


def test_relaying_that_costs_a_lone_transfer_time_is_contention_loss():
    network = rated(line(3, bandwidth_MBps=2.0))
    dag = chain(2, size_MB=4.0, cost=0.0, pins={0: 0, 1: 2})
    chosen = models(
        network,
        [inject(dag)],
        scheduler=ManualScheduler(make_context(network)),
        interference=ToyRelays(network),
    )

    totals = explained(lambda *observers: Simulation(network, chosen, observers=observers)).totals
    assert seconds(totals) == {"transfer_alone": 2.0, "contention_loss": 2.0}


def test_a_coarse_recording_says_that_it_does_not_know():
    totals = explained(worked_example, level="coarse").totals

    assert seconds(totals)["unattributed_loss"] == 0.5


@settings(max_examples=60, deadline=None)
@given(run_cases() | run_cases(decides_routes=True))
def test_the_parts_of_every_completed_run_sum_to_its_makespan(case):
    recorder = RunRecorder()
    outcome = case.simulation(recorder).run()
    if outcome.makespan_us is None:
        with pytest.raises(TraceError, match=f"ended {outcome.status} and has no makespan"):
            explain_run(recorder.run_trace())
        return

    explanation = explain_run(recorder.run_trace())
    assert sum(explanation.totals.values()) == outcome.makespan_us
    assert all(spent_us >= 0 for spent_us in explanation.totals.values())
    assert explanation.totals[Part.UNATTRIBUTED_LOSS] == 0
    at_us = 0
    for item in explanation.chain:
        assert item.start_us == at_us
        assert sum(item.parts.values()) == item.end_us - item.start_us
        at_us = item.end_us
    assert at_us == outcome.makespan_us


@settings(max_examples=40, deadline=None)
@given(run_cases(max_tasks=3))
def test_a_lone_transfer_loses_nothing_except_among_its_own_hops(case):
    recorder = RunRecorder()
    case.simulation(recorder).run()
    run = recorder.run_trace()
    if run.end.makespan_us is None or len(run.remote_transfers) != 1:
        return

    totals = explain_run(run).totals
    assert totals[Part.SHARING_LOSS] == 0
    if len(run.remote_transfers[0].route) == 1:
        assert not any(totals[part] for part in LOSSES)


@given(st.integers(0, 10**12), st.lists(st.floats(0, 1e6), min_size=1).filter(any))
def test_division_by_largest_remainder_is_whole_and_fair(total, weights):
    shares = divide(total, weights)

    assert sum(shares) == total
    assert all(share >= 0 for share in shares)
    whole = math.fsum(weights)
    for share, weight in zip(shares, weights, strict=True):
        assert abs(share - total * weight / whole) <= 1 + 1e-9 * total
