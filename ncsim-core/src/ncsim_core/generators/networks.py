"""Networks by rule: grid, line, ring, star, random geometric, clustered.

A *shape* is where the nodes stand and which pairs are linked, both ways. ``network_of`` turns it
into a ``Network``: nodes ``n0 n1 ...``, links ``l_n0_n1``, in the order of the paper's grids.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, TypeAlias

from ncsim_core.errors import ScenarioError
from ncsim_core.generators.amounts import Amount, amounts
from ncsim_core.generators.paper import CAPACITIES, SPACING_m
from ncsim_core.generators.streams import Draws
from ncsim_core.network import Link, LinkId, Network, Node, NodeId, Position

Pair: TypeAlias = tuple[int, int]
Diagonals: TypeAlias = Literal["none", "checkerboard", "all"]

MAX_PLACEMENTS = 1000
"""Placements that are tried for a connected network."""


class Shape(NamedTuple):
    """Where the nodes stand, and which pairs are linked."""

    positions: Sequence[Position]
    pairs: Iterable[Pair]


@dataclass(frozen=True)
class Equipment:
    """What the nodes and links of a generated network are like.

    Args:
        capacities: Compute units per second: a list that is cycled, one number, or a range
            that each node draws from (stream ``capacity``).
        bandwidth_MBps: Of every link; ``None`` leaves it to the link model.
        latency_s: Of every link.
    """

    capacities: Amount = CAPACITIES
    bandwidth_MBps: float | None = None
    latency_s: float = 0.0


def network_of(
    shape: Shape, equipment: Equipment | None = None, draws: Draws | None = None
) -> Network:
    """Return the network of a shape, both directions of each pair side by side."""
    equipment = equipment or Equipment()
    stream = (draws or Draws()).stream("capacity")
    capacities = amounts(equipment.capacities, len(shape.positions), stream)
    nodes = tuple(
        Node(NodeId(f"n{number}"), capacity, position)
        for number, (capacity, position) in enumerate(zip(capacities, shape.positions, strict=True))
    )
    directed = ((a, b) for low, high in sorted(shape.pairs) for a, b in ((low, high), (high, low)))
    links = tuple(
        Link(
            LinkId(f"l_n{a}_n{b}"),
            NodeId(f"n{a}"),
            NodeId(f"n{b}"),
            equipment.bandwidth_MBps,
            equipment.latency_s,
        )
        for a, b in directed
    )
    return Network(nodes, links)


def linked(network: Network, range_m: float) -> Network:
    """Return a network with a link both ways between all nodes up to ``range_m`` apart.

    Links that are there stay, and no second one is put beside them.

    Raises:
        ScenarioError: A node has no position.
    """
    bare = [node.id for node in network.nodes if node.position is None]
    if bare:
        raise ScenarioError(f"nodes without position: {', '.join(bare)}")
    there = {(link.source, link.target) for link in network.links}
    names = [node.id for node in network.nodes]
    positions = [node.position for node in network.nodes if node.position is not None]
    pairs = [(names[a], names[b]) for a, b in sorted(_within(positions, range_m))]
    new = [
        Link(LinkId(f"{a}_{b}"), a, b)
        for low, high in pairs
        for a, b in ((low, high), (high, low))
        if (a, b) not in there
    ]
    return Network(network.nodes, (*network.links, *new))


def grid(
    rows: int,
    columns: int,
    *,
    spacing_m: float = SPACING_m,
    diagonals: Diagonals = "checkerboard",
) -> Shape:
    """Return a mesh of rows and columns, numbered row by row.

    Args:
        rows: At least 1.
        columns: At least 1.
        spacing_m: Between neighbours.
        diagonals: ``checkerboard`` is the paper's mesh: both in every other square.
    """
    positions = [
        Position(spacing_m * column, spacing_m * row)
        for row in range(rows)
        for column in range(columns)
    ]
    return Shape(positions, list(_grid_pairs(rows, columns, diagonals)))


def line(nodes: int, *, spacing_m: float = SPACING_m) -> Shape:
    """Return nodes in a row, each linked to the next."""
    positions = [Position(spacing_m * number, 0.0) for number in range(nodes)]
    return Shape(positions, [(number, number + 1) for number in range(nodes - 1)])


def ring(nodes: int, *, spacing_m: float = SPACING_m) -> Shape:
    """Return nodes on a circle, neighbours ``spacing_m`` apart and linked.

    Args:
        nodes: At least 3.
        spacing_m: Straight distance between neighbours.
    """
    radius_m = spacing_m / (2 * math.sin(math.pi / nodes))
    pairs = [(number, number + 1) for number in range(nodes - 1)]
    return Shape(_circle(nodes, radius_m), [*pairs, (0, nodes - 1)])


def star(leaves: int, *, radius_m: float = SPACING_m) -> Shape:
    """Return node 0 in the middle, linked to every leaf around it."""
    positions = [Position(0.0, 0.0), *_circle(leaves, radius_m)]
    return Shape(positions, [(0, leaf + 1) for leaf in range(leaves)])


def random_geometric(
    draws: Draws, nodes: int, *, side_m: float, range_m: float, connected: bool = True
) -> Shape:
    """Return nodes anywhere in a square, linked when they are within range.

    Positions come from stream ``placement``; more nodes keep the places of the first ones, as
    long as no second placement is needed to be connected.

    Args:
        draws: Random streams.
        nodes: How many.
        side_m: Side of the square.
        range_m: Longest link.
        connected: Draw again until every node can reach every other.

    Raises:
        ScenarioError: No connected placement was found.
    """
    stream = draws.stream("placement")

    def places() -> list[Position]:
        return [Position(float(x), float(y)) for x, y in stream.random((nodes, 2)) * side_m]

    return _placed(places, range_m, connected=connected)


@dataclass(frozen=True)
class Clusters:
    """How clustered nodes are spread.

    Args:
        count: Clusters, their centres anywhere in the square.
        nodes_each: Nodes per cluster, around its centre.
        side_m: Side of the square.
        spread_m: Standard deviation of a node's offset from its centre, in x and y.
    """

    count: int
    nodes_each: int
    side_m: float
    spread_m: float


def clustered(draws: Draws, clusters: Clusters, *, range_m: float, connected: bool = True) -> Shape:
    """Return nodes in clusters (stream ``placement``), linked when they are within range.

    Raises:
        ScenarioError: No connected placement was found.
    """
    stream = draws.stream("placement")

    def places() -> list[Position]:
        centres = stream.random((clusters.count, 1, 2)) * clusters.side_m
        shape = (clusters.count, clusters.nodes_each, 2)
        offsets = stream.normal(0.0, clusters.spread_m, shape)
        return [Position(float(x), float(y)) for x, y in (centres + offsets).reshape(-1, 2)]

    return _placed(places, range_m, connected=connected)


def is_connected(nodes: int, pairs: Iterable[Pair]) -> bool:
    """Return whether undirected pairs join all nodes.

    >>> is_connected(3, [(0, 1)]), is_connected(3, [(0, 1), (2, 1)])
    (False, True)
    """
    group = list(range(nodes))

    def root(node: int) -> int:
        while group[node] != node:
            group[node] = group[group[node]]
            node = group[node]
        return node

    for a, b in pairs:
        group[root(a)] = root(b)
    return len({root(node) for node in range(nodes)}) <= 1


def _placed(places: Callable[[], list[Position]], range_m: float, *, connected: bool) -> Shape:
    for _ in range(MAX_PLACEMENTS):
        positions = places()
        pairs = _within(positions, range_m)
        if not connected or is_connected(len(positions), pairs):
            return Shape(positions, pairs)
    raise ScenarioError(
        f"none of {MAX_PLACEMENTS} placements was connected; raise range_m (it is {range_m:g}) or "
        "the number of nodes, lower side_m, or set connected: false"
    )


def _within(positions: Sequence[Position], range_m: float) -> list[Pair]:
    return [
        (a, b)
        for b, there in enumerate(positions)
        for a, here in enumerate(positions[:b])
        if math.hypot(here.x_m - there.x_m, here.y_m - there.y_m) <= range_m
    ]


def _circle(nodes: int, radius_m: float) -> list[Position]:
    angles = (2 * math.pi * number / nodes for number in range(nodes))
    return [Position(radius_m * math.cos(angle), radius_m * math.sin(angle)) for angle in angles]


def _grid_pairs(rows: int, columns: int, diagonals: Diagonals) -> Iterator[Pair]:
    for here in range(rows * columns):
        row, column = divmod(here, columns)
        if column + 1 < columns:
            yield here, here + 1
        if row + 1 < rows:
            yield here, here + columns
            for step in _diagonal_steps(diagonals, is_even=(row + column) % 2 == 0):
                if 0 <= column + step < columns:
                    yield here, here + columns + step


def _diagonal_steps(diagonals: Diagonals, *, is_even: bool) -> tuple[int, ...]:
    if diagonals == "none":
        return ()
    if diagonals == "all":
        return (-1, 1)
    return (1,) if is_even else (-1,)
