"""The two searches behind all routing models, with one rule for every tie.

A search starts at one node and leaves, for each node it reaches, the link by which it first got
there as well as it could: its *arrival*. Following arrivals back gives the route. Ids compare
as text, so ``n10`` comes before ``n2``. Only links with bandwidth above 0 count.

A search may stop once its target is settled. What lies behind a settled node is settled too
and never changes, so the short search and the whole one give the same route.

Source: Section IV-E (routing and bandwidth sharing) of the paper; the rule for equals pins
published results.
"""

from collections import deque
from collections.abc import Callable
from heapq import heappop, heappush
from typing import TypeAlias

from ncsim_core.network import LinkIndex, Network, NodeIndex, Route

Arrivals: TypeAlias = list[LinkIndex | None]
"""For each node the last link of its route, ``None`` at the source and where no route leads."""

Extend: TypeAlias = Callable[[float, LinkIndex], float]
"""Gives the cost of a route from the cost of all but its last link, and that link.

A longer route never costs less.
"""


def breadth_first(network: Network, source: NodeIndex, target: NodeIndex | None = None) -> Arrivals:
    """Return arrivals by the fewest links; the first link to reach a node is kept.

    Nodes are expanded in the order in which they were reached, their outgoing links in the
    order of their ids.

    Args:
        network: A network whose rates are decided.
        source: Where routes begin.
        target: Stop when this node is reached; ``None`` reaches all there are.
    """
    outgoing, targets, bandwidth_MBps = network.outgoing, network.targets, network.bandwidth_MBps
    arrivals: Arrivals = [None] * len(network.nodes)
    reached = {source}
    waiting = deque([source])
    while waiting and target not in reached:
        for link in outgoing[waiting.popleft()]:
            end = targets[link]
            if end not in reached and bandwidth_MBps[link] > 0:
                reached.add(end)
                arrivals[end] = link
                waiting.append(end)
    return arrivals


def best_first(
    network: Network,
    source: NodeIndex,
    start_cost: float,
    extend: Extend,
    target: NodeIndex | None = None,
) -> Arrivals:
    """Return arrivals of least cost (Dijkstra); an equal cost never replaces the first link.

    Among nodes of equal cost the lowest id is expanded first, outgoing links in the order of
    their ids.

    Args:
        network: A network whose rates are decided.
        source: Where routes begin.
        start_cost: Cost of the empty route.
        extend: Cost of a route with one link more.
        target: Stop when this node is settled; ``None`` settles all there are.
    """
    outgoing, targets, bandwidth_MBps = network.outgoing, network.targets, network.bandwidth_MBps
    nodes = network.nodes
    arrivals: Arrivals = [None] * len(nodes)
    best_cost = {source: start_cost}
    settled: set[NodeIndex] = set()
    waiting = [(start_cost, nodes[source].id, source)]
    while waiting and target not in settled:
        cost, _, at = heappop(waiting)
        if at in settled:
            continue
        settled.add(at)
        for link in outgoing[at]:
            end = targets[link]
            end_cost = extend(cost, link)
            is_better = end not in best_cost or end_cost < best_cost[end]
            if is_better and bandwidth_MBps[link] > 0:
                best_cost[end] = end_cost
                arrivals[end] = link
                heappush(waiting, (end_cost, nodes[end].id, end))
    return arrivals


def route_to(
    target: NodeIndex, source: NodeIndex, arrivals: Arrivals, network: Network
) -> Route | None:
    """Return the route that a search from ``source`` found, ``None`` if it found none."""
    sources = network.sources
    backwards: list[LinkIndex] = []
    at = target
    while at != source:
        link = arrivals[at]
        if link is None:
            return None
        backwards.append(link)
        at = sources[link]
    backwards.reverse()
    return tuple(backwards)
