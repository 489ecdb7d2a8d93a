"""What a run is set up with, as rows of a trace."""

from ncsim_core.engine.setup import Setup
from ncsim_core.network import Network
from ncsim_core.trace.records import Injected, LinkRow, NodeRow
from ncsim_core.units import Instant


def node_rows(network: Network) -> tuple[NodeRow, ...]:
    """Return the nodes as the header lists them."""
    return tuple(
        NodeRow(
            node.id,
            float(node.compute_capacity),
            None if node.position is None else float(node.position.x_m),
            None if node.position is None else float(node.position.y_m),
        )
        for node in network.nodes
    )


def link_rows(network: Network) -> tuple[LinkRow, ...]:
    """Return the links as the header lists them, with their clean rates."""
    columns = (
        [link.id for link in network.links],
        network.sources,
        network.targets,
        map(float, network.bandwidth_MBps),
        map(float, network.latency_s),
        [link.medium for link in network.links],
    )
    return tuple(map(LinkRow._make, zip(*columns, strict=True)))


def injected_record(setup: Setup, at_us: Instant, dag: int) -> Injected:
    """Return the ``inject`` record of a DAG: the names of its tasks, once."""
    injected = setup.injections[dag].dag
    first_task, first_edge = setup.first_task[dag], setup.first_dependency[dag]
    edges = setup.dependencies[first_edge : first_edge + len(injected.dependencies)]
    return Injected(
        line=0,
        at_us=at_us,
        dag=dag,
        dag_id=injected.id,
        first_task=first_task,
        first_edge=first_edge,
        tasks=[(task.id, float(task.compute_cost)) for task in injected.tasks],
        edges=[(edge.source, edge.target, float(edge.size_MB)) for edge in edges],
    )
