"""One plan by SAGA: total, or an error that says who and what."""

import random

import numpy as np
import pytest
from ncsim_core.errors import PlacementError
from ncsim_core.testing.builders import dag_of, diamond, line, make_snapshot
from ncsim_core.workflow import DAG, Dependency, Task
from ncsim_saga.native.heft import heft
from ncsim_saga.native.instance import instance_of
from ncsim_saga.native.planning_network import planning_network
from ncsim_saga.native.processors import ListProcessors
from ncsim_saga.planning import PlanRequest, plan_with_saga
from ncsim_saga.virtual_network import VirtualNetwork, virtual_network

NETWORK = virtual_network(make_snapshot(line(3, capacities=(80.0, 100.0, 150.0))))
LAYERS = dag_of([(a, b) for a in range(5) for b in range(5, 10)], tasks=10)


def test_a_request_survives_json():
    request = PlanRequest("wba", NETWORK, diamond(cost=0.1, size_MB=1 / 3), {"alpha": 0.1}, 7)

    copy = PlanRequest.from_json(request.to_json())

    assert copy.dag == request.dag
    assert copy.network.speed_MBps == NETWORK.speed_MBps
    assert (copy.scheduler, copy.options, copy.seed) == ("wba", {"alpha": 0.1}, 7)


def test_tasks_left_out_are_an_error_that_names_them():
    with pytest.raises(PlacementError, match=r"hbmct \(anrg-saga .*left tasks of DAG .*'T\d'"):
        plan_with_saga(PlanRequest("hbmct", NETWORK, LAYERS))


def test_an_error_of_sagas_names_scheduler_and_dag():
    """A task without cost and a rounding error: SAGA finds an overlap of its own making."""
    request = failing_request()

    with pytest.raises(PlacementError, match=r"heft \(anrg-saga .*gave up on DAG 'd': ValueError"):
        plan_with_saga(request)


def test_the_native_planner_goes_on_where_saga_gives_up():
    request = failing_request()
    network = planning_network(request.network)

    assert heft(instance_of(request.dag), ListProcessors(network, 0.0)) == [0, 0, 0, 0]


def test_drawing_depends_on_the_seed_alone():
    plans = {
        str(plan_with_saga(PlanRequest("wba", NETWORK, LAYERS, {"alpha": 1.0}, seed)))
        for seed in (1, 2, 3, 1, 2, 3)
    }

    assert len(plans) == 3


def test_the_global_generators_are_left_as_they_were():
    before, numpy_before = random.getstate(), np.random.get_state()[1].tolist()

    plan_with_saga(PlanRequest("wba", NETWORK, LAYERS))

    assert random.getstate() == before
    assert np.random.get_state()[1].tolist() == numpy_before


def test_saga_remembers_no_ranks_of_an_earlier_plan():
    from saga.schedulers import cpop

    plan_with_saga(PlanRequest("heft", NETWORK, LAYERS))

    assert cpop.upward_rank.cache_info().currsize == 0


def failing_request():
    """Return a chain on one node: 0.2 s, 0.1 s, nothing, 0.2 s, which would begin at 0.3 s."""
    tasks = (Task("T0", 0.2), Task("T1", 0.1), Task("T2", 0.0), Task("T3", 0.2))
    sizes_MB = {
        ("T0", "T1"): 0.0,
        ("T0", "T2"): 0.3,
        ("T0", "T3"): 0.0,
        ("T1", "T2"): 1.0,
        ("T2", "T3"): 0.0,
    }
    dependencies = tuple(Dependency(*ends, size_MB) for ends, size_MB in sizes_MB.items())
    network = VirtualNetwork((1.0,), ((10_000.0,),))
    return PlanRequest("heft", network, DAG("d", tasks, dependencies))
