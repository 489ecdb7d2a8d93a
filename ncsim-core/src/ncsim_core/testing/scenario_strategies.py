"""Whole scenario files as plain data, for everything that reads or writes them."""

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn

from ncsim_core.network import Network
from ncsim_core.testing.strategies import dags, networks
from ncsim_core.workflow import DAG


@st.composite
def scenarios(draw: DrawFn, *, max_dags: int = 2) -> dict[str, object]:
    """Return scenario files as plain data, without a ``config`` beyond the seed."""
    network = draw(networks())
    node_ids = [node.id for node in network.nodes]
    listed = [
        {"inject_at": draw(st.sampled_from((0.0, 0.5))), **dag_as_data(dag)}
        for number in range(draw(st.integers(1, max_dags)))
        for dag in [draw(dags(pin_to=tuple(node_ids), dag_id=f"dag_{number}"))]
    ]
    config = {"seed": draw(st.integers(0, 2**31 - 1))}
    body = {"name": "drawn", "network": network_as_data(network), "dags": listed, "config": config}
    return {"scenario": body}


def network_as_data(network: Network) -> dict[str, object]:
    """Return a network as it stands in a scenario file."""
    nodes = [
        {"id": str(node.id), "compute_capacity": node.compute_capacity}
        | ({"position": {"x": at.x_m, "y": at.y_m}} if (at := node.position) else {})
        for node in network.nodes
    ]
    links = [
        {"id": str(link.id), "from": str(link.source), "to": str(link.target)}
        | ({} if link.bandwidth_MBps is None else {"bandwidth": link.bandwidth_MBps})
        | {"latency": link.latency_s}
        for link in network.links
    ]
    return {"nodes": nodes, "links": links}


def dag_as_data(dag: DAG) -> dict[str, object]:
    """Return a DAG as it stands in a scenario file, without its time."""
    tasks = [
        {"id": str(task.id), "compute_cost": task.compute_cost}
        | ({} if task.pinned_to is None else {"pinned_to": str(task.pinned_to)})
        for task in dag.tasks
    ]
    edges = [
        {"from": str(each.source), "to": str(each.target), "data_size": each.data_size_MB}
        for each in dag.dependencies
    ]
    return {"id": str(dag.id), "tasks": tasks, "edges": edges}
