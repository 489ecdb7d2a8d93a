"""Hypothesis strategies: small networks, DAGs, traffic, options and whole scenarios.

Small is on purpose: faults of plug-ins show on five nodes, and small examples can be read.
Draws include what is easily forgotten: no links, links without bandwidth, zero sizes, two nodes at
one place, two links between the same nodes, file orders that differ from id orders.
"""

from collections.abc import Sequence

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from ncsim_core.contracts.queue_model import WaitingTask
from ncsim_core.network import Link, LinkId, Medium, Network, Node, NodeId, Position
from ncsim_core.testing.option_strategies import options_for, radios, sections
from ncsim_core.testing.questions import Case
from ncsim_core.workflow import DAG, DagId, Dependency, Injection, Task, TaskId

__all__ = [
    "arrivals",
    "dag_as_data",
    "dags",
    "instances",
    "network_as_data",
    "networks",
    "options_for",
    "radios",
    "scenarios",
    "sections",
    "traffic",
    "waiting_lines",
    "waiting_task",
]

CAPACITIES = (50.0, 80.0, 100.0, 250.0)
BANDWIDTHS_MBps = (0.0, 1.0, 2.5, 10.0, 40.0)
LATENCIES_s = (0.0, 0.0, 0.01, 0.25)
COSTS = (0.0, 1.0, 100.0, 500.0)
SIZES_MB = (0.0, 1.0, 10.0, 12.5)


@st.composite
def networks(
    draw: DrawFn, *, max_nodes: int = 5, max_links: int = 10, is_bandwidth_optional: bool = False
) -> Network:
    """Return networks without decided rates.

    Args:
        draw: Given by hypothesis.
        max_nodes: At least 1.
        max_links: Parallel links count.
        is_bandwidth_optional: Leave some links' bandwidth to the link model.
    """
    count = draw(st.integers(1, max_nodes))
    numbers = draw(st.permutations(range(count)))
    nodes = tuple(
        Node(NodeId(f"n{number}"), draw(st.sampled_from(CAPACITIES)), draw(_positions()))
        for number in numbers
    )
    if count == 1:
        return Network(nodes, ())
    pairs = [(a.id, b.id) for a in nodes for b in nodes if a is not b]
    ends = draw(st.lists(st.sampled_from(pairs), max_size=max_links))
    is_bare = is_bandwidth_optional and draw(st.booleans())
    names = draw(st.permutations([LinkId(f"l{k}") for k in range(len(ends))]))
    return Network(
        nodes,
        tuple(
            draw(_links(name, *pair, is_bare=is_bare))
            for name, pair in zip(names, ends, strict=True)
        ),
    )


def _positions() -> SearchStrategy[Position]:
    coordinate = st.integers(0, 8).map(lambda k: 25.0 * k)
    return st.builds(Position, coordinate, coordinate)


def _links(name: LinkId, source: NodeId, target: NodeId, *, is_bare: bool) -> SearchStrategy[Link]:
    bandwidths: Sequence[float | None] = (None,) if is_bare else BANDWIDTHS_MBps
    media: Sequence[Medium] = ("wireless", "wireless", "wireless", "wired")
    return st.builds(
        Link,
        st.just(name),
        st.just(source),
        st.just(target),
        st.sampled_from(bandwidths),
        st.sampled_from(LATENCIES_s),
        st.just("wireless") if is_bare else st.sampled_from(media),
    )


@st.composite
def dags(
    draw: DrawFn,
    *,
    max_tasks: int = 6,
    pin_to: Sequence[NodeId] = (),
    dag_id: str = "dag",
) -> DAG:
    """Return DAGs; with ``pin_to``, none, some or all of their tasks are pinned to these nodes."""
    count = draw(st.integers(1, max_tasks))
    ids = [TaskId(f"T{number}") for number in draw(st.permutations(range(count)))]
    pinned = draw(st.sampled_from(("none", "some", "all"))) if pin_to else "none"
    pins: SearchStrategy[NodeId | None] = st.none()
    if pinned != "none":
        pins = st.sampled_from(pin_to)
    if pinned == "some":
        pins = st.none() | pins
    costs, sizes = st.sampled_from(COSTS), st.sampled_from(SIZES_MB)
    tasks = tuple(Task(name, draw(costs), draw(pins)) for name in ids)
    pairs = [(a, b) for a in range(count) for b in range(a + 1, count)]
    chosen = (
        draw(st.lists(st.sampled_from(pairs), unique=True, max_size=2 * count)) if pairs else []
    )
    return DAG(
        DagId(dag_id),
        tuple(draw(st.permutations(tasks))),
        tuple(Dependency(ids[a], ids[b], draw(sizes)) for a, b in chosen),
    )


@st.composite
def instances(draw: DrawFn, *, max_nodes: int = 4, max_tasks: int = 6) -> Case:
    """Return a network and a DAG to place on it."""
    network = draw(networks(max_nodes=max_nodes))
    ids = [node.id for node in network.nodes]
    return Case(network, dag=draw(dags(max_tasks=max_tasks, pin_to=ids)))


@st.composite
def traffic(draw: DrawFn, *, max_nodes: int = 6, max_links: int = 10) -> Case:
    """Return a network with links in use and a series of links to switch on and off."""
    network = draw(networks(max_nodes=max_nodes, max_links=max_links, is_bandwidth_optional=True))
    if not network.links:
        return Case(network)
    link = st.sampled_from(range(len(network.links)))
    return Case(
        network,
        active=tuple(draw(st.lists(link, unique=True))),
        toggles=tuple(draw(st.lists(link, max_size=16))),
    )


@st.composite
def waiting_lines(draw: DrawFn, *, max_length: int = 12) -> Case:
    """Return pushes and pops of tasks that became ready one after another."""
    length = draw(st.integers(0, max_length))
    costs, pauses = st.sampled_from(COSTS), st.sampled_from((0, 0, 5))
    waiting: list[WaitingTask | None] = []
    ready_us = 0
    for ticket in range(length):
        ready_us += draw(pauses)
        waiting.append(waiting_task(ticket, draw(costs), ready_us))
        if draw(st.booleans()):
            waiting.append(None)
    return Case(Network((Node(NodeId("n0"), 100.0),), ()), waiting=tuple(waiting))


def waiting_task(ticket: int, compute_cost: float, ready_us: int) -> WaitingTask:
    """Return a task of one of two DAGs, told from the others by its ticket."""
    name = TaskId(f"T{ticket}")
    return WaitingTask(DagId(f"d{ticket % 2}"), name, compute_cost, ready_us, ticket)


@st.composite
def arrivals(draw: DrawFn, *, max_dags: int = 3) -> Case:
    """Return a network and the DAGs that a scenario lists, in no order of time."""
    network = draw(networks(max_nodes=3, max_links=2))
    times = draw(st.lists(st.sampled_from((0, 1, 250_000, 1_000_000)), max_size=max_dags))
    listed = (
        Injection(at_us, draw(dags(max_tasks=3, dag_id=f"d{number}")))
        for number, at_us in enumerate(times)
    )
    return Case(network, injections=tuple(listed))


@st.composite
def scenarios(draw: DrawFn, *, max_dags: int = 2) -> dict[str, object]:
    """Return scenario files as plain data, without a ``config`` beyond the seed."""
    network = draw(networks())
    node_ids = [node.id for node in network.nodes]
    listed = [
        {"inject_at": draw(st.sampled_from((0.0, 0.5))), **dag_as_data(dag)}
        for number in range(draw(st.integers(1, max_dags)))
        for dag in [draw(dags(pin_to=node_ids, dag_id=f"dag_{number}"))]
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
