"""How runs go and how they end."""

import re

import numpy as np
import pytest
from ncsim_core.builtin.routing_models import DirectRouting
from ncsim_core.builtin.schedulers import ManualScheduler
from ncsim_core.contracts.queue_model import QueueModel
from ncsim_core.contracts.scheduler import Scheduler
from ncsim_core.engine.outcome import RunStatus
from ncsim_core.engine.setup import Limits
from ncsim_core.engine.simulation import Simulation
from ncsim_core.engine.state import TaskStatus
from ncsim_core.network import Link, LinkRates, Network, Node
from ncsim_core.testing.builders import (
    chain,
    dag_of,
    fork_join,
    inject,
    line,
    make_context,
    network_of,
    scattered,
)
from ncsim_core.testing.toys import ToyRadio, models
from ncsim_core.workflow import PlacementPlan


def simulation_of(network, *dags, limits=None, **components):
    injections = [each if not hasattr(each, "tasks") else inject(each) for each in dags]
    components.setdefault("scheduler", ManualScheduler(make_context(network)))
    return Simulation(network, models(network, injections, **components), limits)


def run(network, *dags, **options):
    simulation = simulation_of(network, *dags, **options)
    simulation.run()
    return simulation


def ends_us(simulation):
    return [task.ended_us for task in simulation.state.tasks]


def starts_us(simulation):
    return [task.started_us for task in simulation.state.tasks]


def test_compute_durations_round_to_the_nearest_microsecond():
    network = line(1, capacities=[300.0])

    simulation = run(network, chain(1, cost=500.0, pins={0: 0}))

    assert simulation.outcome.makespan_us == 1_666_667


def test_transfer_completions_round_up():
    network = line(2, bandwidth_MBps=3.0)

    simulation = run(network, chain(2, cost=0.0, size_MB=10.0, pins={0: 0, 1: 1}))

    assert simulation.outcome.makespan_us == 3_333_334


def test_an_exact_end_is_not_pushed_one_tick_on():
    network = line(2, bandwidth_MBps=0.1)

    simulation = run(network, chain(2, cost=0.0, size_MB=0.3, pins={0: 0, 1: 1}))

    assert simulation.outcome.makespan_us == 3_000_000


def test_zero_cost_tasks_complete_in_the_same_instant():
    simulation = run(line(1), chain(50, cost=0.0, pins=dict.fromkeys(range(50), 0)))

    assert simulation.outcome.makespan_us == 0
    assert simulation.outcome.status is RunStatus.COMPLETED


def test_latency_is_paid_once_and_leaves_the_route_idle():
    network = line(3, bandwidth_MBps=1.0, latency_s=0.25)
    dag = dag_of([(0, 2), (1, 3)], tasks=4, cost=0.0, size_MB=1.0, pins={0: 0, 1: 1, 2: 2, 3: 2})

    simulation = run(network, dag)

    # The one-hop transfer starts at 0.25 s alone; the two-hop one joins at 0.5 s.
    assert ends_us(simulation)[3] == 2_000_000
    assert ends_us(simulation)[2] == 2_250_000


def test_same_node_dependencies_cost_nothing():
    simulation = run(line(1), chain(2, cost=100.0, size_MB=1e9, pins={0: 0, 1: 0}))

    assert simulation.outcome.makespan_us == 2_000_000
    assert simulation.state.transfers == {}


def test_zero_bytes_complete_after_latency_even_at_zero_rate():
    network = line(2, latency_s=0.5)
    stopped = ToyRadio({0: [0]}, stop_at=0)

    simulation = run(
        network, chain(2, cost=0.0, size_MB=0.0, pins={0: 0, 1: 1}), interference=stopped
    )

    assert simulation.outcome.status is RunStatus.COMPLETED
    assert simulation.outcome.makespan_us == 500_000


def test_a_freed_node_goes_to_its_queue_before_what_becomes_ready_at_that_instant():
    # T0 and T1 run on n0 one after the other; T2 follows T0 there.
    dag = dag_of([(0, 2)], tasks=3, pins={0: 0, 1: 0, 2: 0})

    simulation = run(line(1), dag)

    assert starts_us(simulation) == [0, 1_000_000, 2_000_000]


def test_transfers_that_end_together_run_in_text_order_of_their_names():
    # Both transfers end at the same microsecond; T10 < T9 as text, so T10 -> T12 comes first.
    pins = {9: 0, 10: 0, 11: 1, 12: 1}
    edges = [(9, 11), (10, 12)]
    network = network_of([None, None], [(0, 1)], capacities=[1e9, 100.0])
    dag = dag_of(
        edges, tasks=13, cost=0.0, size_MB=10.0, pins={k: pins.get(k, 0) for k in range(13)}
    )

    simulation = run(network, dag)

    order = sorted(
        (11, 12), key=lambda task: simulation.state.transfers[{11: 0, 12: 1}[task]].entry.rank
    )
    assert order == [12, 11]
    assert ends_us(simulation)[11] == ends_us(simulation)[12] == 2_000_000


def test_zero_rate_transfer_resumes_when_competition_ends():
    network = network_of([None] * 4, [(0, 1), (2, 3)], bandwidth_MBps=1.0)
    edges = [(0, 1), (2, 3)]
    dag = dag_of(edges, tasks=4, cost=0.0, size_MB=1.0, pins={0: 0, 1: 1, 2: 2, 3: 3})
    # Link n2_n3 (index 2) stops while link n0_n1 (index 0) is active.
    blocked = ToyRadio({2: [0]}, stop_at=1)

    simulation = run(network, dag, interference=blocked)

    assert simulation.outcome.status is RunStatus.COMPLETED
    assert ends_us(simulation)[1] == 1_000_000
    assert ends_us(simulation)[3] == 2_000_000


def test_mutually_stalled_transfers_end_the_run_blocked_and_named():
    network = network_of([None] * 4, [(0, 1), (2, 3)], bandwidth_MBps=1.0)
    dag = dag_of([(0, 1), (2, 3)], tasks=4, cost=0.0, size_MB=1.0, pins={k: k for k in range(4)})
    stalled = ToyRadio({0: [2], 2: [0]}, stop_at=1)

    outcome = run(network, dag, interference=stalled).outcome

    assert outcome.status is RunStatus.BLOCKED_WIRELESS
    assert outcome.makespan_us is None
    assert "dag: T0 -> T1 (1 MB left, stalled on link n0_n1)" in outcome.detail


def test_a_transfer_that_joins_a_stopped_link_is_paused_too():
    network = network_of([None] * 4, [(0, 1), (2, 3)], bandwidth_MBps=1.0)
    edges = [(0, 1), (2, 3), (4, 5)]
    dag = dag_of(edges, tasks=6, cost=0.0, size_MB=1.0, pins={0: 0, 1: 1, 2: 2, 3: 3, 4: 2, 5: 3})
    blocked = ToyRadio({2: [0]}, stop_at=1)

    simulation = run(network, dag, interference=blocked)

    assert ends_us(simulation)[1] == 1_000_000
    assert ends_us(simulation)[3] == ends_us(simulation)[5] == 3_000_000


def test_unroutable_dependencies_are_found_at_injection_and_all_listed():
    dag = fork_join(2, cost=0.0, size_MB=0.0, pins={0: 0, 1: 1, 2: 0, 3: 0})

    outcome = run(scattered(2), dag, routing=DirectRouting(make_context(scattered(2)))).outcome

    assert outcome.status is RunStatus.UNROUTABLE
    assert outcome.makespan_us is None
    assert outcome.detail == (
        "2 dependencies without a usable route: "
        "dag: T0 on n0 -> T1 on n1; dag: T1 on n1 -> T3 on n0"
    )


def test_links_without_bandwidth_are_not_usable():
    network = line(2, bandwidth_MBps=0.0)

    outcome = run(network, chain(2, pins={0: 0, 1: 1})).outcome

    assert outcome.status is RunStatus.UNROUTABLE
    assert outcome.detail.endswith("-> T1 on n1. Links without bandwidth: n0_n1, n1_n0")


@pytest.mark.parametrize("limits", [Limits(max_events=3), Limits(max_time_us=500_000)])
def test_limits_end_a_run_without_makespan(limits):
    outcome = run(line(1), chain(2, pins={0: 0, 1: 0}), limits=limits).outcome

    assert outcome.status is RunStatus.LIMIT_REACHED
    assert outcome.makespan_us is None


def test_a_limit_that_is_just_enough_does_not_stop_a_run():
    events = run(line(1), chain(2, pins={0: 0, 1: 0})).outcome.events

    outcome = run(line(1), chain(2, pins={0: 0, 1: 0}), limits=Limits(max_events=events)).outcome

    assert outcome.status is RunStatus.COMPLETED


def test_makespan_is_the_absolute_time_of_the_last_task():
    first, second = (chain(1, dag_id=name, pins={0: 0}) for name in ("a", "b"))

    outcome = run(line(1), inject(first, 0.0), inject(second, 5.0)).outcome

    assert outcome.makespan_us == 6_000_000


def test_later_injections_queue_behind_earlier_work():
    dags = [inject(chain(1, dag_id=f"d{k}", pins={0: 0}), 0.5 * k) for k in range(4)]

    simulation = run(line(1), *dags)

    assert ends_us(simulation) == [1_000_000, 2_000_000, 3_000_000, 4_000_000]


def test_a_run_without_tasks_completes_at_once():
    outcome = run(line(1), dag_of([], tasks=0)).outcome

    assert outcome.status is RunStatus.COMPLETED
    assert outcome.makespan_us == 0


def test_stepping_shows_the_five_states_of_a_task():
    network = line(1)
    simulation = simulation_of(network, chain(1, pins={0: 0}), dag_of([], tasks=0, dag_id="e"))
    seen = [simulation.state.tasks[0].status]
    while simulation.step() is not None:
        seen.append(simulation.state.tasks[0].status)

    assert list(dict.fromkeys(seen)) == [
        TaskStatus.PENDING,
        TaskStatus.READY,
        TaskStatus.RUNNING,
        TaskStatus.COMPLETED,
    ]


def test_a_task_waits_in_the_queue_while_its_node_is_busy():
    simulation = simulation_of(line(1), dag_of([], tasks=2, pins={0: 0, 1: 0}))
    for _ in range(3):
        simulation.step()

    assert simulation.state.tasks[1].status is TaskStatus.QUEUED


def test_observers_cannot_join_a_run_under_way():
    simulation = simulation_of(line(1), chain(1, pins={0: 0}))
    simulation.step()

    with pytest.raises(ValueError, match="before the first event"):
        simulation.observe(object())


class Answering(Scheduler):
    def __init__(self, answer):
        self.answer = answer

    def schedule(self, dag, snapshot):
        if isinstance(self.answer, BaseException):
            raise self.answer
        return self.answer


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (None, "answered with None instead of a PlacementPlan"),
        (PlacementPlan({"T0": "n0"}), "left tasks of DAG 'dag' unplaced: 'T1'"),
        (
            PlacementPlan({"T0": "n0", "T1": "n0", "T2": "n0"}),
            "placed what is no task of DAG 'dag': 'T2'",
        ),
        (PlacementPlan({"T0": "n0", "T1": "mars"}), "task 'T1' is placed on unknown node 'mars'"),
        (
            PlacementPlan({"T0": "n0", "T1": ["n0"]}),
            r"task 'T1' is placed on unknown node \['n0'\]",
        ),
        (ZeroDivisionError("oops"), r"raised ZeroDivisionError: oops \(.*test_simulation.py, line"),
        (SystemExit(3), r"raised SystemExit: 3"),
    ],
)
def test_a_bad_plan_fails_the_run_and_names_the_scheduler(answer, message):
    outcome = run(line(1), chain(2), scheduler=Answering(answer)).outcome

    assert outcome.status is RunStatus.FAILED
    assert outcome.makespan_us is None
    assert outcome.detail.startswith("scheduler 'unnamed' (unknown 0)")
    assert re.search(message, outcome.detail)


@pytest.mark.parametrize("factor", [-0.1, 1.1, float("nan"), float("inf")])
def test_a_factor_outside_zero_and_one_fails_the_run(factor):
    class Wrong(ToyRadio):
        def factors(self, links, active):
            return super().factors(links, active) * 0 + factor

    outcome = run(line(2), chain(2, pins={0: 0, 1: 1}), interference=Wrong({})).outcome

    assert outcome.status is RunStatus.FAILED
    assert f"the factor {factor!r}, not 0 to 1" in outcome.detail


@pytest.mark.parametrize(
    ("method", "answer", "message"),
    [
        ("factors", [1.0], "factors() gave list, not an array of shape (1,)"),
        ("factors", None, "factors() gave NoneType"),
        ("factors", np.ones(9), "factors() gave (9,), not an array of shape (1,)"),
        ("reach", None, "reach() gave None, not a collection of links"),
    ],
)
def test_an_answer_of_the_wrong_form_is_told_as_such(method, answer, message):
    wrong = type("Wrong", (ToyRadio,), {method: lambda *_: answer})

    outcome = run(line(2), chain(2, pins={0: 0, 1: 1}), interference=wrong({})).outcome

    assert outcome.status is RunStatus.FAILED
    assert message in outcome.detail


def test_a_queue_that_invents_tasks_fails_the_run():
    class Inventing(QueueModel):
        def __init__(self, context):
            self.count = 0

        def push(self, task):
            self.count += 1

        def pop(self):
            return "T7"

        def __len__(self):
            return self.count

    outcome = run(line(1), dag_of([], tasks=2, pins={0: 0, 1: 0}), queue=Inventing).outcome

    assert outcome.status is RunStatus.FAILED
    assert "popped 'T7', which does not wait on this node" in outcome.detail


def test_pins_override_the_plan():
    plan = PlacementPlan({"T0": "n0", "T1": "n0"})

    simulation = run(line(2), chain(2, pins={1: 1}), scheduler=Answering(plan))

    assert [task.node for task in simulation.state.tasks] == [0, 1]


def test_round_robin_goes_on_from_dag_to_dag_and_pins_do_not_move_it():
    network = line(3)
    dags = [
        inject(dag_of([], tasks=2, dag_id="a", pins={0: 2})),
        inject(dag_of([], tasks=2, dag_id="b"), 1.0),
    ]

    simulation = Simulation(network, models(network, dags))
    simulation.run()

    assert [task.node for task in simulation.state.tasks] == [2, 0, 1, 2]


def test_direct_routing_takes_the_lowest_usable_link_id():
    nodes = (Node("a", 1.0), Node("b", 1.0))
    links = (Link("z", "a", "b"), Link("m", "a", "b"), Link("c", "a", "b"))
    network = Network(nodes, links, LinkRates((1.0, 1.0, 0.0), (0.0, 0.0, 0.0)))

    assert DirectRouting(make_context(network)).route(0, 1, network) == (1,)


def test_a_long_chain_meets_no_recursion_limit():
    length = 20_000
    dag = chain(length, cost=1.0, pins=dict.fromkeys(range(length), 0))

    outcome = run(line(1), dag).outcome

    assert outcome.makespan_us == length * 10_000
