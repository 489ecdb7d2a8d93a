"""Both kinds of processors give equal plans, whatever the network's size and the load."""

import random

import pytest
from ncsim_core.workflow import DAG, Dependency, Task
from ncsim_saga.native import array_processors
from ncsim_saga.native.array_processors import ArrayProcessors
from ncsim_saga.native.cpop import cpop
from ncsim_saga.native.heft import heft
from ncsim_saga.native.instance import instance_of
from ncsim_saga.native.planning_network import planning_network
from ncsim_saga.native.processors import ListProcessors
from ncsim_saga.virtual_network import VirtualNetwork


def problem(seed, nodes, tasks, width, *, has_ties):
    """Return a layered DAG and a network, drawn with many equal numbers or with none."""
    draw = random.Random(seed)
    capacities = [draw.choice([80, 100, 100, 200]) for _ in range(nodes)]
    speeds = [[draw.choice([0.001, 2.6, 3.3]) for _ in range(nodes)] for _ in range(nodes)]

    def number(among, low, high):
        return float(draw.choice(among)) if has_ties else draw.uniform(low, high)

    dag = DAG(
        "d",
        tuple(Task(f"T{index}", number([0, 250, 500], 1, 500)) for index in range(tasks)),
        tuple(
            Dependency(f"T{parent}", f"T{child}", number([0, 10, 10], 1, 20))
            for child in range(width, tasks)
            for layer in [child // width]
            for parent in draw.sample(range((layer - 1) * width, layer * width), 2)
        ),
    )
    return dag, VirtualNetwork(tuple(map(float, capacities)), tuple(map(tuple, speeds)))


@pytest.mark.parametrize("few_candidates", [0, 24, 10_000])
@pytest.mark.parametrize("algorithm", [heft, cpop])
@pytest.mark.parametrize("has_ties", [True, False])
@pytest.mark.parametrize("shape", [(1, 20, 4), (7, 90, 30), (60, 200, 25)])
def test_lists_and_arrays_plan_alike(shape, has_ties, algorithm, few_candidates, monkeypatch):
    monkeypatch.setattr(array_processors, "FEW_CANDIDATES", few_candidates)
    for seed in range(3):
        dag, virtual = problem(seed, *shape, has_ties=has_ties)
        instance, network = instance_of(dag), planning_network(virtual)
        least_cost = min(instance.costs)

        by_lists = algorithm(instance, ListProcessors(network, least_cost))
        by_arrays = algorithm(instance, ArrayProcessors(network, least_cost))
        assert by_lists == by_arrays
