"""The virtual network in SAGA's order of nodes and links."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from weakref import WeakKeyDictionary

from ncsim_saga.hash_order import all_pair_hashes, name_hash, pair_hash, walking_order
from ncsim_saga.virtual_network import VirtualNetwork, node_name

MAX_REMEMBERED_SIZES = 16

MANY_NODES = 48
"""From here on numpy is worth its import; see ``benchmarks/planner.py``."""


@dataclass(frozen=True)
class Walk:
    """The orders in which SAGA walks a network of a given size; names alone decide them.

    Args:
        nodes: Node indices. A *position* is a place in this tuple.
        links: Flat indices ``source * nodes + target`` of the virtual links.
        governing: For each pair of positions, flat, the link whose speed SAGA uses for both
            directions: its graph is undirected, and the link that is walked last prevails.
    """

    nodes: tuple[int, ...]
    links: tuple[int, ...]
    governing: tuple[int, ...]


@lru_cache(maxsize=MAX_REMEMBERED_SIZES)
def walk_of(node_count: int) -> Walk:
    """Return the orders of a network with this many nodes."""
    names = [node_name(index) for index in range(node_count)]
    nodes = walking_order(map(name_hash, names))
    links = walking_order(_link_hashes(names))
    last = dict.fromkeys(range(node_count * node_count), 0)
    for link in links:
        source, target = divmod(link, node_count)
        last[link] = last[target * node_count + source] = link
    return Walk(
        tuple(nodes),
        tuple(links),
        tuple(last[source * node_count + target] for source in nodes for target in nodes),
    )


def _link_hashes(names: Sequence[str]) -> Iterable[int]:
    """Return the hashes of all virtual links; small networks do without numpy."""
    if len(names) < MANY_NODES:
        return (pair_hash(source, target) for source in names for target in names)
    return all_pair_hashes(names)


@dataclass(frozen=True, eq=False)
class PlanningNetwork:
    """Everything about a network that does not change while a plan is made, by position.

    Args:
        nodes: Node index at each position.
        capacities: Compute units per second.
        link_speed_MBps: Speeds of all virtual links in SAGA's order.
        pair_speed_MBps: From each position to each position, row by row; symmetric.
    """

    nodes: tuple[int, ...]
    capacities: tuple[float, ...]
    link_speed_MBps: tuple[float, ...]
    pair_speed_MBps: tuple[tuple[float, ...], ...]

    @cached_property
    def mean_link_slowness(self) -> float:
        """Return the mean of ``1 / speed`` over all virtual links, within a few roundings."""
        total = math.fsum(1.0 / speed_MBps for speed_MBps in self.link_speed_MBps)
        return total / len(self.link_speed_MBps)


_known: WeakKeyDictionary[VirtualNetwork, PlanningNetwork] = WeakKeyDictionary()


def planning_network(network: VirtualNetwork) -> PlanningNetwork:
    """Return a virtual network in SAGA's order, worked out once."""
    known = _known.get(network)
    if known is None:
        known = _known[network] = _in_saga_order(network)
    return known


def _in_saga_order(network: VirtualNetwork) -> PlanningNetwork:
    count = len(network)
    walk = walk_of(count)
    speed_MBps = [float(speed) for row in network.speed_MBps for speed in row]
    governing = [speed_MBps[link] for link in walk.governing]
    return PlanningNetwork(
        walk.nodes,
        tuple(float(network.capacities[node]) for node in walk.nodes),
        tuple(speed_MBps[link] for link in walk.links),
        tuple(tuple(governing[row : row + count]) for row in range(0, count * count, count)),
    )
