"""SAGA is handed what SPEC 21 and 22 say, in an order that no hash seed changes."""

from ncsim_core.testing.builders import chain, dag_of, line, make_snapshot
from ncsim_saga.hash_order import name_hash, pair_hash
from ncsim_saga.native.instance import instance_of
from ncsim_saga.native.planning_network import walk_of
from ncsim_saga.translate import saga_network, saga_task_graph
from ncsim_saga.virtual_network import VirtualNetwork, virtual_network

ASYMMETRIC = VirtualNetwork((1.0, 2.0), ((10_000.0, 3.0), (5.0, 10_000.0)))


def test_both_directions_and_the_nodes_themselves_are_there():
    speeds = {(each.source, each.target): each.speed for each in saga_network(ASYMMETRIC).edges}

    assert speeds == {
        ("n0", "n0"): 10_000.0,
        ("n0", "n1"): 3.0,
        ("n1", "n0"): 5.0,
        ("n1", "n1"): 10_000.0,
    }


def test_no_super_source_or_sink_is_added():
    graph = saga_task_graph(dag_of((), tasks=3))

    assert sorted(task.name for task in graph.tasks) == ["T0", "T1", "T2"]


def test_elements_hash_as_under_seed_zero():
    network, graph = saga_network(ASYMMETRIC), saga_task_graph(chain(2))

    assert all(hash(node) == name_hash(node.name) for node in network.nodes)
    assert all(hash(edge) == pair_hash(edge.source, edge.target) for edge in network.edges)
    assert all(hash(task) == name_hash(task.name) for task in graph.tasks)
    assert all(hash(each) == pair_hash(each.source, each.target) for each in graph.dependencies)


def test_the_native_planner_walks_as_saga_does():
    virtual = virtual_network(make_snapshot(line(9)))
    walk = walk_of(9)
    network = saga_network(virtual)

    assert [node.name for node in network.nodes] == [f"n{index}" for index in walk.nodes]
    assert [(edge.source, edge.target) for edge in network.edges] == [
        (f"n{link // 9}", f"n{link % 9}") for link in walk.links
    ]


def test_the_native_planner_reads_tasks_as_saga_does():
    dag = dag_of([(a, b) for b in range(12) for a in range(b) if (a * b) % 3 == 1], tasks=12)
    instance, graph = instance_of(dag), saga_task_graph(dag)

    assert [dag.tasks[task].id for task in instance.walk] == [task.name for task in graph.tasks]
    assert [dag.tasks[task].id for task in instance.topological] == [
        task.name for task in graph.topological_sort()
    ]
