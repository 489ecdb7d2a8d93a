"""What the routing models of this package share: one search answers one source."""

from abc import abstractmethod
from collections.abc import Sequence
from typing import overload

from ncsim_core.context import BuildContext
from ncsim_core.contracts.routing_model import RoutingModel
from ncsim_core.network import Network, NodeIndex, Route
from typing_extensions import override

from ncsim_routing.search import Arrivals, route_to


class FoundRoutes(Sequence[Route | None]):
    """The routes that one search has found, each followed back when it is asked for.

    A network of n nodes has n^2 routes, of which a run uses few.
    """

    def __init__(self, source: NodeIndex, arrivals: Arrivals, network: Network) -> None:
        self._source = source
        self._arrivals = arrivals
        self._network = network

    @override
    def __len__(self) -> int:
        return len(self._arrivals)

    @overload
    def __getitem__(self, target: NodeIndex) -> Route | None: ...

    @overload
    def __getitem__(self, target: slice) -> list[Route | None]: ...

    @override
    def __getitem__(self, target: NodeIndex | slice) -> Route | list[Route | None] | None:
        if isinstance(target, slice):
            return [self[each] for each in range(*target.indices(len(self)))]
        return route_to(range(len(self))[target], self._source, self._arrivals, self._network)


class SearchingRouting(RoutingModel):
    """Follows back what a search from the source has found."""

    def __init__(self, context: BuildContext) -> None:
        del context

    @abstractmethod
    def arrivals(
        self, source: NodeIndex, network: Network, target: NodeIndex | None = None
    ) -> Arrivals:
        """Return the last link of the best route to each node, or at least to ``target``."""

    @override
    def route(self, source: NodeIndex, target: NodeIndex, network: Network) -> Route | None:
        return route_to(target, source, self.arrivals(source, network, target), network)

    @override
    def routes_from(self, source: NodeIndex, network: Network) -> Sequence[Route | None]:
        return FoundRoutes(source, self.arrivals(source, network), network)
