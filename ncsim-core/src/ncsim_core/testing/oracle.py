"""Slow and obvious answers that fast ones are compared with."""

from collections import deque
from collections.abc import Iterator
from typing import TYPE_CHECKING

from typing_extensions import override

from ncsim_core.contracts.routing_model import RoutingModel
from ncsim_core.network import Network, NodeIndex, Route

if TYPE_CHECKING:
    pass


class FewestHops(RoutingModel):
    """Breadth-first search over usable links, outgoing links in id order."""

    @override
    def route(self, source: NodeIndex, target: NodeIndex, network: Network) -> Route | None:
        routes: dict[NodeIndex, Route] = {source: ()}
        waiting = deque([source])
        while waiting:
            at = waiting.popleft()
            if at == target:
                return routes[at]
            for link in network.outgoing[at]:
                reached = network.targets[link]
                if reached not in routes and network.bandwidth_MBps[link] > 0:
                    routes[reached] = (*routes[at], link)
                    waiting.append(reached)
        return None


def all_routes(source: NodeIndex, target: NodeIndex, network: Network) -> Iterator[Route]:
    """Yield every loop-free route over usable links; for networks of a handful of nodes."""
    if source == target:
        yield ()
        return
    waiting: list[tuple[NodeIndex, Route, frozenset[NodeIndex]]] = [
        (source, (), frozenset({source}))
    ]
    while waiting:
        at, route, visited = waiting.pop()
        for link in network.outgoing[at]:
            reached = network.targets[link]
            if reached in visited or network.bandwidth_MBps[link] <= 0:
                continue
            if reached == target:
                yield (*route, link)
            else:
                waiting.append((reached, (*route, link), visited | {reached}))


def route_value(objective: str, route: Route, network: Network) -> float:
    """Return what a routing model with this objective minimises.

    Args:
        objective: ``hops``, ``latency`` or ``bottleneck``.
        route: Any route.
        network: A network whose rates are decided.
    """
    values = {
        "hops": float(len(route)),
        "latency": network.route_latency_s(route),
        "bottleneck": -network.route_bottleneck_MBps(route),
    }
    return values[objective]


def best_value(
    objective: str, source: NodeIndex, target: NodeIndex, network: Network
) -> float | None:
    """Return the least ``route_value`` over all routes, ``None`` if there is no route."""
    values = [
        route_value(objective, route, network) for route in all_routes(source, target, network)
    ]
    return min(values, default=None)
