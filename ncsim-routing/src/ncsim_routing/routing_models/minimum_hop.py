"""Routes with the fewest links."""

from ncsim_core.network import Network, NodeIndex
from typing_extensions import override

from ncsim_routing.routing_models.searching import SearchingRouting
from ncsim_routing.search import Arrivals, breadth_first


class MinimumHopRouting(SearchingRouting):
    """Takes the fewest links.

    Among routes of equal length the one whose nodes were reached first wins, outgoing links
    taken in the order of their ids.

    Source: Section IV-E, MinimumHop.
    """

    @override
    def arrivals(
        self, source: NodeIndex, network: Network, target: NodeIndex | None = None
    ) -> Arrivals:
        return breadth_first(network, source, target)
