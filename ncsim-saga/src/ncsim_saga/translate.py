"""From ncsim's description of a planning problem to SAGA's, element by element in file order."""

from typing import TYPE_CHECKING

from ncsim_saga.virtual_network import VirtualNetwork, node_name

if TYPE_CHECKING:
    import saga
    from ncsim_core.workflow import DAG


def saga_network(network: VirtualNetwork) -> "saga.Network":
    """Return SAGA's network: both directions and each node with itself.

    It is built with the constructor, which keeps both directions; ``Network.create`` would keep
    one (SPEC 21). Lists, because SAGA's own set is then grown in exactly this order.
    """
    import saga

    from ncsim_saga.elements import SeededLink, SeededNode

    names = [node_name(index) for index in range(len(network))]
    return saga.Network(
        nodes=[
            SeededNode(name=name, speed=capacity)
            for name, capacity in zip(names, network.capacities, strict=True)
        ],
        edges=[
            SeededLink(source=source, target=target, speed=speed_MBps)
            for source, row in zip(names, network.speed_MBps, strict=True)
            for target, speed_MBps in zip(names, row, strict=True)
        ],
    )


def saga_task_graph(dag: "DAG") -> "saga.TaskGraph":
    """Return SAGA's task graph, without the super source and sink that ``create`` would add."""
    import saga

    from ncsim_saga.elements import SeededDependency, SeededTask

    return saga.TaskGraph(
        tasks=[SeededTask(name=task.id, cost=task.compute_cost) for task in dag.tasks],
        dependencies=[
            SeededDependency(source=each.source, target=each.target, size=each.data_size_MB)
            for each in dag.dependencies
        ],
    )
