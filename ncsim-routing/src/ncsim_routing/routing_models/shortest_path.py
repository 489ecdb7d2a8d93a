"""Routes with the least latency."""

from ncsim_core.network import LinkIndex, Network, NodeIndex
from typing_extensions import override

from ncsim_routing.routing_models.searching import SearchingRouting
from ncsim_routing.search import Arrivals, best_first


class ShortestPathRouting(SearchingRouting):
    """Minimises the sum of the configured latencies along the route.

    Where all latencies are zero every route ties and the order of the search decides, not the
    number of links; ``minimum_hop`` is the better choice there.

    Source: Section IV-E, ShortestPath.
    """

    @override
    def arrivals(
        self, source: NodeIndex, network: Network, target: NodeIndex | None = None
    ) -> Arrivals:
        latency_s = network.latency_s

        def delayed(cost_s: float, link: LinkIndex) -> float:
            return cost_s + latency_s[link]

        return best_first(network, source, 0.0, delayed, target)
