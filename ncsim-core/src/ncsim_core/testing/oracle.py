"""Slow and obvious answers that fast ones are compared with."""

from collections import deque
from collections.abc import Collection, Iterator, Sequence
from typing import TYPE_CHECKING

from typing_extensions import override

from ncsim_core.contracts.interference_model import (
    Competition,
    InterferenceModel,
    InterferenceSession,
    PlainSession,
)
from ncsim_core.contracts.routing_model import RoutingModel
from ncsim_core.network import LinkIndex, Network, NodeIndex, Route

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class GlobalRefresh(InterferenceModel):
    """The same model, asked about every active link after every change.

    A run with this must equal the run with the model itself: local refresh is exact.
    """

    def __init__(self, model: InterferenceModel) -> None:
        self._model = model

    @override
    def factors(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> "NDArray[np.float64]":
        return self._model.factors(links, active)

    @override
    def reach(self, changed: Collection[LinkIndex]) -> Collection[LinkIndex]:
        return self._model.reach(changed)

    @override
    def competition(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> Sequence[Competition]:
        return self._model.competition(links, active)

    @override
    def open_session(self) -> InterferenceSession:
        return PlainSession(self._model, is_global=True)


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
