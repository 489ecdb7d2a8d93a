"""Routing models that break their contract."""

from ncsim_core.builtin.routing_models import DirectRouting
from ncsim_core.testing.oracle import FewestHops


class Hops(FewestHops):
    def __init__(self, context):
        pass


class RoutesAreChains(Hops):
    def route(self, source, target, network):
        route = super().route(source, target, network)
        return None if route is None else route[::-1]


class RouteToItselfIsEmpty(Hops):
    def route(self, source, target, network):
        return None if source == target else super().route(source, target, network)


class ThereIsARouteIfThereCanBe(DirectRouting):
    """Takes one link only, and does not say so."""


class ListingOrderChangesNothing(Hops):
    def route(self, source, target, network):
        for link, ends in enumerate(zip(network.sources, network.targets, strict=True)):
            if ends == (source, target) and network.bandwidth_MBps[link] > 0:
                return (link,)
        return super().route(source, target, network)


class RoutesFromEqualsRoute(Hops):
    def routes_from(self, source, network):
        return [None for _ in network.nodes]


class RoutesAreOptimal(Hops):
    """Takes the fewest links where it declares the least latency."""


class SeedlessRoutesIgnoreTheSeed(Hops):
    """Draws whether there is a way, and says that it does not draw."""

    def __init__(self, context):
        self._is_lucky = context.rng("luck").random() < 0.5

    def route(self, source, target, network):
        return super().route(source, target, network) if self._is_lucky else None
