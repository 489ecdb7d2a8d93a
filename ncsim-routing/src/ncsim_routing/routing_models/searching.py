"""What the routing models of this package share: one search answers one source."""

from abc import abstractmethod
from collections.abc import Sequence

from ncsim_core.context import BuildContext
from ncsim_core.contracts.routing_model import RoutingModel
from ncsim_core.network import Network, NodeIndex, Route
from typing_extensions import override

from ncsim_routing.search import Arrivals, route_to


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
        arrivals = self.arrivals(source, network)
        return [route_to(target, source, arrivals, network) for target in range(len(network.nodes))]
