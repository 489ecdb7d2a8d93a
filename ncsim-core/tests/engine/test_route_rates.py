"""A model that decides routes is asked about all of them, in one order, and believed or not."""

from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import given, settings
from ncsim_core.api import result_of
from ncsim_core.builtin.schedulers import ManualScheduler
from ncsim_core.contracts.interference_model import RouteRates
from ncsim_core.engine.observer import Observer
from ncsim_core.engine.outcome import RunStatus
from ncsim_core.engine.simulation import Simulation
from ncsim_core.models import ComponentIdentity
from ncsim_core.testing.builders import inject, line, make_context, rated
from ncsim_core.testing.toys import ToyRelays, models
from ncsim_core.testing.whole_runs import run_cases
from ncsim_core.workflow import DAG, Dependency, Task

LINE = rated(line(4, bandwidth_MBps=2.0))


class Listening(ToyRelays):
    """Keeps what it was asked."""

    def __init__(self, network):
        super().__init__(network)
        self.asked = []

    def route_rates(self, routes):
        self.asked.append(list(routes))
        return super().route_rates(routes)


class Rates(Observer):
    """Keeps which transfers' rates moved."""

    def __init__(self):
        self.moved = []

    def rates_assigned(self, at_us, cause, changes):
        self.moved.append([(each.transfer, each.rate_MBps) for each in changes])


def transfers(*ends, size_MB=4.0, each_later=0.0):
    """Return a DAG of lone transfers between pairs of nodes of the line.

    Each of their tasks costs ``each_later`` more than the one before.
    """
    tasks = [
        Task(f"{side}{k}", k * each_later, f"n{node}")
        for k, pair in enumerate(ends)
        for side, node in zip("ab", pair, strict=True)
    ]
    edges = [Dependency(f"a{k}", f"b{k}", size_MB * (k + 1)) for k in range(len(ends))]
    return DAG("dag", tuple(tasks), tuple(edges))


def run(interference, dag, *observers):
    chosen = models(
        LINE,
        [inject(dag)],
        scheduler=ManualScheduler(make_context(LINE)),
        interference=interference,
    )
    return Simulation(LINE, chosen, observers=observers).run()


def test_all_routes_are_asked_about_at_every_start_and_finish_in_ascending_order():
    model = Listening(LINE)

    run(model, transfers((2, 3), (0, 3), (0, 1), (0, 1), each_later=1.0))
    assert [len(routes) for routes in model.asked] == [1, 2, 3, 4, 3, 2, 1]
    assert all(one <= other for routes in model.asked for one, other in pairwise(routes))


def test_only_transfers_whose_rate_moves_are_touched():
    rates = Rates()

    dag = transfers((0, 1), (2, 3), (0, 1), each_later=1.0)
    outcome = run(ToyRelays(LINE), dag, rates)
    assert outcome.status is RunStatus.COMPLETED
    assert rates.moved == [
        [(0, 2.0)],
        [(1, 2.0)],
        [(0, 1.0), (2, 1.0)],
        [(2, 2.0)],
    ]


def test_starts_of_one_instant_are_asked_about_together():
    model, rates = Listening(LINE), Rates()

    run(model, transfers((0, 1), (2, 3), (0, 1)), rates)
    assert [len(routes) for routes in model.asked] == [3, 2, 1]
    assert rates.moved == [[(0, 1.0), (1, 2.0), (2, 1.0)], [(2, 2.0)]]


def test_a_start_is_not_left_to_one_without_bytes_that_follows():
    dag = transfers((0, 1), (2, 3))
    empty = replace(dag.dependencies[1], data_size_MB=0.0)
    model = Listening(LINE)

    outcome = run(model, replace(dag, dependencies=(dag.dependencies[0], empty)))
    assert outcome.makespan_us == 2_000_000
    assert [len(routes) for routes in model.asked] == [1]


@settings(max_examples=60, deadline=None)
@given(run_cases(decides_routes=True))
def test_asking_once_for_several_starts_changes_no_result(case):
    once, each_time = case.simulation(), case.simulation()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("ncsim_core.engine.refresh.is_followed_by_a_start", lambda *_: False)
        each_time.run()

    assert once.run() == each_time.outcome
    assert result_of(once) == result_of(each_time)


def test_a_relay_that_halves_its_route_takes_twice_the_time():
    assert run(ToyRelays(LINE), transfers((0, 3))).makespan_us == 4_000_000


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (([-1.0], [0]), "gave route [0, 2] the rate -1.0 MB/s"),
        (([float("nan")], [0]), "gave route [0, 2] the rate nan MB/s"),
        (([float("inf")], [0]), "gave route [0, 2] the rate inf MB/s"),
        (([2.1], [0]), "lets link 'n0_n1' of 2.0 MB/s carry 2.1 MB/s"),
        (([1.0], [4]), "gave route [0, 2] the bottleneck 4, which is not on it"),
        (([1.0, 1.0], [0]), "gave 2 rates and 1 bottlenecks for 1 routes"),
        (([], []), "gave 0 rates and 0 bottlenecks for 1 routes"),
        (None, "raised TypeError"),
    ],
)
def test_an_answer_that_cannot_be_fails_the_run_and_names_the_plugin(answer, message):
    class Wrong(ToyRelays):
        def route_rates(self, routes):
            return answer if answer is None else RouteRates(*answer)

    who = ComponentIdentity("interference_model", "wrong", "wrong-dist", "1.2")
    chosen = models(
        LINE,
        [inject(transfers((0, 2)))],
        scheduler=ManualScheduler(make_context(LINE)),
        interference=Wrong(LINE),
    )
    chosen = replace(chosen, identities={"interference_model": who})

    outcome = Simulation(LINE, chosen).run()
    assert outcome.status is RunStatus.FAILED
    assert outcome.detail.startswith("interference_model 'wrong' (wrong-dist 1.2) ")
    assert message in outcome.detail


def test_a_model_without_an_answer_fails_the_run():
    class Mute(ToyRelays):
        route_rates = ToyRelays.__mro__[1].route_rates

    outcome = run(Mute(LINE), transfers((0, 1)))
    assert outcome.status is RunStatus.FAILED
    assert "Mute has no route_rates()" in outcome.detail
