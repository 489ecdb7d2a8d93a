"""Link models that break their contract."""

from ncsim_core.builtin.link_models import StaticLinkModel
from ncsim_core.network import LinkRates


class EveryLinkIsRated(StaticLinkModel):
    def rate_links(self, network):
        rates = super().rate_links(network)
        return LinkRates(rates.bandwidth_MBps[:3], rates.latency_s[:3])


class RatesAreOrdinaryNumbers(StaticLinkModel):
    def rate_links(self, network):
        rates = super().rate_links(network)
        bandwidths = [10.0 / each if each else float("inf") for each in rates.bandwidth_MBps]
        return LinkRates.of(bandwidths, rates.latency_s)


class ListingOrderChangesNothing(StaticLinkModel):
    def rate_links(self, network):
        rates = super().rate_links(network)
        return LinkRates.of(range(len(network.links)), rates.latency_s)
