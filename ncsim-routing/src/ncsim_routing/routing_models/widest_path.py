"""Routes with the widest bottleneck."""

import math

from ncsim_core.network import LinkIndex, Network, NodeIndex
from typing_extensions import override

from ncsim_routing.routing_models.searching import SearchingRouting
from ncsim_routing.search import Arrivals, best_first


class WidestPathRouting(SearchingRouting):
    """Maximises the least clean bandwidth along the route, however many links it takes.

    Routes of equal bottleneck are told apart by the order of the search alone: there is no
    second objective, so a wide detour is taken if it was found first.

    Source: Section IV-E, WidestPath.
    """

    @override
    def arrivals(
        self, source: NodeIndex, network: Network, target: NodeIndex | None = None
    ) -> Arrivals:
        bandwidth_MBps = network.bandwidth_MBps

        def narrowed(cost: float, link: LinkIndex) -> float:
            return max(cost, -bandwidth_MBps[link])

        return best_first(network, source, -math.inf, narrowed, target)
