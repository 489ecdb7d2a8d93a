"""An interference model as data is checked before the engine works on it."""

from dataclasses import replace

import numpy as np
import pytest
from ncsim_core.builtin.schedulers import ManualScheduler
from ncsim_core.contracts.interference_tables import InterferenceTables, ShareRow
from ncsim_core.engine.outcome import RunStatus
from ncsim_core.engine.setup import Reach
from ncsim_core.engine.simulation import Simulation
from ncsim_core.errors import PluginError
from ncsim_core.models import ComponentIdentity
from ncsim_core.network import Link, LinkRates, Network, Node
from ncsim_core.testing.builders import inject, make_context
from ncsim_core.testing.toys import ToyRadio, models
from ncsim_core.workflow import DAG, Dependency, Task

PAIRS = Network(
    tuple(Node(f"n{k}", 1.0) for k in range(6)),
    tuple(Link(f"l{k}", f"n{2 * k}", f"n{2 * k + 1}") for k in range(3)),
    LinkRates.of([2.0] * 3, [0.0] * 3),
)
NEAR, FAR = {0: [1], 1: [0]}, {0: [2], 1: [2]}
"""Links 0 and 1 contend, and link 2 disturbs both unheard."""


def tables(factor_of=lambda stations: 1 / stations, **changed):
    clean, disturbed = ShareRow(factor_of), ShareRow(lambda stations: 0.75 * factor_of(stations))
    whole = {
        "starts": np.array([0, 1, 2, 4]),
        "links": np.array([1, 0, 0, 1], np.int32),
        "is_conflict": np.array([True, True, False, False]),
        "hidden_units": np.array([0, 0, 5, 5]),
        "limits": [(0,)] * 3,
        "shares": [(clean, disturbed)] * 3,
        "hidden_factors": [(1.0, 0.75)] * 3,
    }
    return InterferenceTables(**(whole | changed))


class Declared(ToyRadio):
    """The toy radio with tables beside it."""

    def __init__(self, given):
        super().__init__(NEAR, FAR)
        self.given = given

    def tables(self):
        return self.given


def run(given, reach=Reach.LOCAL):
    sizes_MB = (4.0, 3.0, 1.0)
    tasks = [
        Task(f"{side}{k}", 0.0, f"n{2 * k + (side == 'R')}") for k in range(3) for side in "SR"
    ]
    edges = tuple(Dependency(f"S{k}", f"R{k}", size) for k, size in enumerate(sizes_MB))
    chosen = models(
        PAIRS,
        [inject(DAG("d", tuple(tasks), edges))],
        scheduler=ManualScheduler(make_context(PAIRS)),
        interference=Declared(given),
    )
    who = ComponentIdentity("interference_model", "declared", "some-dist", "1.2")
    chosen = replace(chosen, identities={"interference_model": who})
    return Simulation(PAIRS, chosen, reach=reach).run()


def test_a_run_on_tables_goes_like_one_that_asks_the_model_about_everything():
    outcome = run(tables())

    assert outcome.status is RunStatus.COMPLETED
    assert outcome == run(tables(), Reach.GLOBAL) == run(None)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"starts": np.array([0, 1, 2])}, "2 rows and 3 limits for 3 links"),
        ({"limits": [(0,)] * 2}, "3 rows and 2 limits for 3 links"),
        ({"starts": np.array([0, 2, 1, 4])}, "rows that do not cover its 4 entries"),
        ({"starts": np.array([0, 1, 2, 3])}, "rows that do not cover its 4 entries"),
        ({"shares": [()] * 3}, "shares that do not fit the levels of its links"),
        ({"hidden_factors": [(1.0,)] * 3}, "hidden_factors that do not fit the levels"),
        ({"is_conflict": np.array([True])}, "arrays of entries of different lengths"),
        ({"links": np.array([1, 0, 0, 3], np.int32)}, "entries about links that do not exist"),
        ({"hidden_units": np.array([0, 0, 5, 0])}, "a hidden power below one quantum"),
    ],
)
def test_tables_that_cannot_be_stop_the_run_before_it_begins(changed, message):
    with pytest.raises(PluginError) as caught:
        run(tables(**changed))

    assert str(caught.value).startswith("interference_model 'declared' (some-dist 1.2) ")
    assert message in str(caught.value)


@pytest.mark.parametrize("factor", [-0.1, 1.5, float("nan")])
def test_a_factor_outside_zero_and_one_in_the_tables_fails_the_run(factor):
    outcome = run(tables(lambda stations: 1.0 if stations == 1 else factor))

    assert outcome.status is RunStatus.FAILED
    assert f"the factor {factor!r}" in outcome.detail
