"""The routing model that needs no search."""

from typing_extensions import override

from ncsim_core.context import BuildContext
from ncsim_core.contracts.routing_model import RoutingModel
from ncsim_core.network import Network, NodeIndex, Route


class DirectRouting(RoutingModel):
    """Takes the one link from source to target, the lowest id if there are several."""

    def __init__(self, context: BuildContext) -> None:
        del context

    @override
    def route(self, source: NodeIndex, target: NodeIndex, network: Network) -> Route | None:
        if source == target:
            return ()
        for link in network.outgoing[source]:
            if network.targets[link] == target and network.bandwidth_MBps[link] > 0:
                return (link,)
        return None
