"""Small networks, DAGs and contexts for tests, readable at the point of use.

Nodes are called ``n0``, ``n1``, ...; the link from ``n0`` to ``n1`` is called ``n0_n1``. Networks
come with their clean rates decided, so that every kind of component can be built on them.
"""

from collections.abc import Iterable, Mapping, Sequence

from ncsim_core.context import BuildContext, ModelCache
from ncsim_core.contracts.routing_model import RouteTable, RoutingModel
from ncsim_core.contracts.scheduler import NetworkSnapshot
from ncsim_core.network import Link, LinkId, LinkRates, Network, Node, NodeId, Position
from ncsim_core.testing.oracle import FewestHops
from ncsim_core.units import us_from_s
from ncsim_core.workflow import DAG, DagId, Dependency, Injection, Task, TaskId

SPACING_m = 40.0


def node(number: int, compute_capacity: float = 100.0, at: Position | None = None) -> Node:
    """Return node ``n<number>``."""
    return Node(NodeId(f"n{number}"), compute_capacity, at)


def link(
    source: int, target: int, bandwidth_MBps: float | None = 10.0, latency_s: float = 0.0
) -> Link:
    """Return link ``n<source>_n<target>``."""
    ends = (NodeId(f"n{source}"), NodeId(f"n{target}"))
    return Link(LinkId("_".join(ends)), *ends, bandwidth_MBps, latency_s)


def rated(network: Network, default_MBps: float = 10.0) -> Network:
    """Return the network with the rates written in it decided, ``default_MBps`` where none is."""
    bandwidths = [
        default_MBps if each.bandwidth_MBps is None else each.bandwidth_MBps
        for each in network.links
    ]
    return network.with_rates(LinkRates.of(bandwidths, [each.latency_s for each in network.links]))


def network_of(
    positions: Sequence[Position],
    pairs: Iterable[tuple[int, int]],
    *,
    bandwidth_MBps: float | None = 10.0,
    latency_s: float = 0.0,
    capacities: Sequence[float] = (100.0,),
) -> Network:
    """Return nodes at these positions and both links of each pair; capacities are cycled."""
    nodes = tuple(
        node(number, capacities[number % len(capacities)], position)
        for number, position in enumerate(positions)
    )
    links = tuple(
        link(*ends, bandwidth_MBps, latency_s) for a, b in pairs for ends in ((a, b), (b, a))
    )
    return rated(Network(nodes, links))


def line(
    length: int,
    *,
    bandwidth_MBps: float | None = 10.0,
    latency_s: float = 0.0,
    capacities: Sequence[float] = (100.0,),
    spacing_m: float = SPACING_m,
) -> Network:
    """Return ``length`` nodes in a row, neighbours linked both ways."""
    return network_of(
        [Position(spacing_m * number, 0.0) for number in range(length)],
        [(number, number + 1) for number in range(length - 1)],
        bandwidth_MBps=bandwidth_MBps,
        latency_s=latency_s,
        capacities=capacities,
    )


def grid(
    rows: int,
    columns: int,
    *,
    bandwidth_MBps: float | None = 10.0,
    capacities: Sequence[float] = (100.0,),
    spacing_m: float = SPACING_m,
) -> Network:
    """Return nodes row by row, linked both ways to the right and lower neighbour."""
    places = [(row, column) for row in range(rows) for column in range(columns)]
    right = [(i, i + 1) for i, (_, column) in enumerate(places) if column + 1 < columns]
    below = [(i, i + columns) for i, (row, _) in enumerate(places) if row + 1 < rows]
    return network_of(
        [Position(spacing_m * column, spacing_m * row) for row, column in places],
        sorted(right + below),
        bandwidth_MBps=bandwidth_MBps,
        capacities=capacities,
    )


def star(
    leaves: int, *, bandwidth_MBps: float | None = 10.0, capacities: Sequence[float] = (100.0,)
) -> Network:
    """Return a hub ``n0`` linked both ways with each of its leaves."""
    return network_of(
        [Position(0.0, 0.0), *(Position(SPACING_m, SPACING_m * k) for k in range(leaves))],
        [(0, leaf) for leaf in range(1, leaves + 1)],
        bandwidth_MBps=bandwidth_MBps,
        capacities=capacities,
    )


def scattered(count: int, *, capacities: Sequence[float] = (100.0,)) -> Network:
    """Return nodes without any link."""
    return network_of(
        [Position(SPACING_m * k, 0.0) for k in range(count)], (), capacities=capacities
    )


def parallel_links(count: int, spacing_m: float, length_m: float = 30.0) -> Network:
    """Return separate links side by side, each from ``n<2k>`` to ``n<2k+1>``, without bandwidth.

    This is the arrangement of the paper's contention studies; rates are 10 MB/s until a link
    model says otherwise.
    """
    nodes = tuple(
        node(2 * k + end, at=Position(length_m * end, spacing_m * k))
        for k in range(count)
        for end in (0, 1)
    )
    return rated(Network(nodes, tuple(link(2 * k, 2 * k + 1, None) for k in range(count))))


def dag_of(
    edges: Iterable[tuple[int, int]],
    *,
    tasks: int,
    cost: float = 100.0,
    size_MB: float = 10.0,
    dag_id: str = "dag",
    pins: Mapping[int, int] | None = None,
) -> DAG:
    """Return tasks ``T0``, ``T1``, ... with equal costs and sizes; ``pins`` is task to node."""
    on = pins or {}
    return DAG(
        DagId(dag_id),
        tuple(
            Task(TaskId(f"T{k}"), cost, NodeId(f"n{on[k]}") if k in on else None)
            for k in range(tasks)
        ),
        tuple(Dependency(TaskId(f"T{a}"), TaskId(f"T{b}"), size_MB) for a, b in edges),
    )


def chain(
    length: int,
    *,
    cost: float = 100.0,
    size_MB: float = 10.0,
    dag_id: str = "dag",
    pins: Mapping[int, int] | None = None,
) -> DAG:
    """Return tasks that each hand data to the next."""
    edges = [(k, k + 1) for k in range(length - 1)]
    return dag_of(edges, tasks=length, cost=cost, size_MB=size_MB, dag_id=dag_id, pins=pins)


def fork_join(
    width: int,
    *,
    cost: float = 100.0,
    size_MB: float = 10.0,
    dag_id: str = "dag",
    pins: Mapping[int, int] | None = None,
) -> DAG:
    """Return ``T0``, then ``width`` tasks that it feeds, then one that waits for them all."""
    middle = range(1, width + 1)
    edges = [(0, k) for k in middle] + [(k, width + 1) for k in middle]
    return dag_of(edges, tasks=width + 2, cost=cost, size_MB=size_MB, dag_id=dag_id, pins=pins)


def diamond(
    *,
    cost: float = 100.0,
    size_MB: float = 10.0,
    dag_id: str = "dag",
    pins: Mapping[int, int] | None = None,
) -> DAG:
    """Return the fork-join of width two."""
    return fork_join(2, cost=cost, size_MB=size_MB, dag_id=dag_id, pins=pins)


def inject(dag: DAG, at_s: float = 0.0) -> Injection:
    """Return a DAG entering at a time."""
    return Injection(us_from_s(at_s), dag)


def make_context(
    network: Network,
    *,
    seed: int = 42,
    sections: Mapping[str, Mapping[str, object]] | None = None,
    injections: Sequence[Injection] = (),
) -> BuildContext:
    """Return a build context with a cache of its own, so that tests do not meet."""
    return BuildContext(network, seed, sections or {}, tuple(injections), ModelCache())


def make_snapshot(
    network: Network, routing: RoutingModel | None = None, *, free_tasks_placed: int = 0
) -> NetworkSnapshot:
    """Return an idle network as a scheduler sees it, by default with fewest-hops routes."""
    return NetworkSnapshot(
        network=network,
        routes=RouteTable(routing or FewestHops(), network),
        queue_depths=(0,) * len(network.nodes),
        free_tasks_placed=free_tasks_placed,
    )
