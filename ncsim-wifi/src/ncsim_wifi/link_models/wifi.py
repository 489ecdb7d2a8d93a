"""The link model that derives goodput from positions and radio parameters."""

from dataclasses import replace
from typing import Literal, TypeAlias

from ncsim_core.context import BuildContext
from ncsim_core.contracts.link_model import LinkModel
from ncsim_core.errors import ScenarioError
from ncsim_core.network import LinkRates, Network
from ncsim_core.units import MEGABITS_PER_MEGABYTE
from typing_extensions import override

from ncsim_wifi.mac.efficiency import station_goodput_MBps
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.propagation import is_on_air, propagation, require_positions
from ncsim_wifi.radio import Radio

Rate: TypeAlias = Literal["solo", "raw_phy"]


class WifiLinkModel(LinkModel):
    """Gives each wireless link the goodput that its signal-to-noise ratio allows.

    A wired link keeps its bandwidth. The bandwidth of a wireless link, if it has one, is
    taken as its clean PHY rate in MB/s.

    Source: Section IV-F (``sec:wifi``), B = R eta(1, R) / 8 above Eq. 12 (``eq:combined``).

    Args:
        context: Network and config section ``rf``.
        rate: ``solo`` for goodput with the overhead of medium access, ``raw_phy`` without it.
    """

    def __init__(self, context: BuildContext, *, rate: Rate = "solo") -> None:
        self._context = context
        self._radio = Radio.from_section(context.section("rf"))
        self._rate = rate

    @override
    def rate_links(self, network: Network) -> LinkRates:
        _check(network)
        context = replace(self._context, network=network)
        clean_Mbps = propagation(context, self._radio).rate_Mbps.tolist()
        goodput_MBps = {rate: self.goodput_MBps(rate) for rate in dict.fromkeys(clean_Mbps)}
        return LinkRates.of(
            [
                goodput_MBps[rate_Mbps] if is_on_air(link) else link.bandwidth_MBps or 0.0
                for link, rate_Mbps in zip(network.links, clean_Mbps, strict=True)
            ],
            [link.latency_s for link in network.links],
        )

    def goodput_MBps(self, rate_Mbps: float) -> float:
        """Return what a link with this clean PHY rate offers alone."""
        if self._rate == "raw_phy":
            return rate_Mbps / MEGABITS_PER_MEGABYTE
        return station_goodput_MBps(1, rate_Mbps, AxTiming(self._radio.rts_cts))


def _check(network: Network) -> None:
    """Raise for wired links without bandwidth and wireless ones without anything to go by."""
    bare = [
        link.id for link in network.links if not is_on_air(link) and link.bandwidth_MBps is None
    ]
    if bare:
        raise ScenarioError(
            f"link model wifi: wired links without bandwidth: {', '.join(map(repr, bare))}; "
            "give each a bandwidth in MB/s"
        )
    derived = [
        index
        for index, link in enumerate(network.links)
        if is_on_air(link) and link.bandwidth_MBps is None
    ]
    require_positions(network, derived, "link model wifi")
