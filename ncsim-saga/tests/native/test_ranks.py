"""Ranks: exact where it matters, rough where it does not."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_core.workflow import DAG, Dependency, Task
from ncsim_saga.native.array_processors import ArrayProcessors
from ncsim_saga.native.instance import instance_of
from ncsim_saga.native.planning_network import planning_network
from ncsim_saga.native.processors import ListProcessors
from ncsim_saga.native.ranks import (
    by_urgency,
    exact_downward_ranks,
    exact_upward_ranks,
    relative_error,
    rough_longest_way,
    upward_ranks,
)
from ncsim_saga.planning import saga_network, saga_task_graph
from ncsim_saga.virtual_network import VirtualNetwork

VIRTUAL = VirtualNetwork(
    tuple(np.random.default_rng(1).uniform(50, 300, 9).tolist()),
    tuple(map(tuple, np.random.default_rng(2).uniform(0.5, 9, (9, 9)).tolist())),
)


@st.composite
def dags(draw, numbers):
    count = draw(st.integers(1, 12))
    tasks = tuple(Task(f"T{index}", draw(numbers)) for index in range(count))
    pairs = [(a, b) for b in range(count) for a in range(b)]
    ends = draw(st.lists(st.sampled_from(pairs), unique=True)) if pairs else []
    return DAG("d", tasks, tuple(Dependency(f"T{a}", f"T{b}", draw(numbers)) for a, b in ends))


ANY_DAG = dags(st.floats(0, 1000)) | dags(st.sampled_from([0.0, 1.0, 10.0, 500.0]))


@pytest.mark.parametrize("kind", [ListProcessors, ArrayProcessors])
@settings(max_examples=50, deadline=None)
@given(dag=ANY_DAG)
def test_exact_ranks_are_sagas_to_the_last_bit(kind, dag):
    from saga.schedulers import cpop

    instance, processors = instance_of(dag), kind(planning_network(VIRTUAL), 0.0)
    saga = (saga_network(VIRTUAL), saga_task_graph(dag))

    ups, downs = cpop.upward_rank.__wrapped__(*saga), cpop.downward_rank(*saga)
    assert exact_upward_ranks(instance, processors) == [ups[task.id] for task in dag.tasks]
    assert exact_downward_ranks(instance, processors) == [downs[task.id] for task in dag.tasks]


@settings(max_examples=50, deadline=None)
@given(dag=ANY_DAG)
def test_rough_ranks_keep_their_bound_and_change_no_order(dag):
    instance, processors = instance_of(dag), ListProcessors(planning_network(VIRTUAL), 0.0)
    rough = upward_ranks(instance, processors, rough_longest_way(processors))
    exact = exact_upward_ranks(instance, processors)

    assert rough == pytest.approx(exact, rel=2 * relative_error(instance), abs=0)
    assert by_urgency(instance, processors) == sorted(
        instance.topological, key=exact.__getitem__, reverse=True
    )


def test_equal_ranks_keep_their_topological_order():
    dag = DAG("d", tuple(Task(f"T{index}", 1.0) for index in range(30)), ())
    instance = instance_of(dag)

    order = by_urgency(instance, ListProcessors(planning_network(VIRTUAL), 1.0))
    assert tuple(order) == instance.topological == instance.walk
