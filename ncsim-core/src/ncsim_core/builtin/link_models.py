"""The link model that takes bandwidths as they are written."""

from typing_extensions import override

from ncsim_core.context import BuildContext
from ncsim_core.contracts.link_model import LinkModel
from ncsim_core.errors import ScenarioError, some_of
from ncsim_core.network import LinkRates, Network

MAX_NAMED = 8
"""Links that a message lists."""


class StaticLinkModel(LinkModel):
    """Gives each link the bandwidth of the scenario file."""

    def __init__(self, context: BuildContext) -> None:
        del context

    @override
    def rate_links(self, network: Network) -> LinkRates:
        bare = [link.id for link in network.links if link.bandwidth_MBps is None]
        if bare:
            names = some_of([*map(repr, bare)], MAX_NAMED)
            raise ScenarioError(
                f"link model static: links without bandwidth: {names}; give each a bandwidth in "
                "MB/s, or choose a link model that derives it, such as wifi"
            )
        return LinkRates.of(
            [link.bandwidth_MBps or 0.0 for link in network.links],
            [link.latency_s for link in network.links],
        )
