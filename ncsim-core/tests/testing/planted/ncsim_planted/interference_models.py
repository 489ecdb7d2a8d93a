"""Interference models that break their contract, and the good one that they are made of."""

import numpy as np
from ncsim_core.contracts.interference_model import (
    Competition,
    InterferenceModel,
    PlainSession,
    RouteRates,
)
from ncsim_core.contracts.interference_tables import InterferenceTables, ShareRow
from ncsim_core.testing.toys import ToyRelays


class TakeTurns(InterferenceModel):
    """Gives each of k active links that meet at a node 1/k."""

    def __init__(self, context):
        ends = [{link.source, link.target} for link in context.network.links]
        self.near = [
            {other for other, theirs in enumerate(ends) if mine & theirs} - {link}
            for link, mine in enumerate(ends)
        ]

    def contenders(self, link, active):
        return len(self.near[link].intersection(active))

    def factors(self, links, active):
        return np.array([1.0 / (1 + self.contenders(link, active)) for link in links])

    def reach(self, changed):
        return set(changed).union(*(self.near[link] for link in changed))


class FactorsAreShares(TakeTurns):
    def factors(self, links, active):
        return np.array([1.5 - self.contenders(link, active) for link in links])


class AloneALinkKeepsItsBandwidth(TakeTurns):
    def factors(self, links, active):
        return 0.9 * super().factors(links, active)


class OrderOfLinksChangesNothing(TakeTurns):
    def factors(self, links, active):
        first = next(iter(active), None)
        return np.array([1.0 if link == first else 0.5 for link in links])


class AskingForFewerChangesNothing(TakeTurns):
    def factors(self, links, active):
        return super().factors(links, links)


class ReachHoldsWhatChanged(TakeTurns):
    def reach(self, changed):
        return set().union(*(self.near[link] for link in changed))


class OutOfReachNothingChanges(TakeTurns):
    def reach(self, changed):
        return set(changed)


class Forgetful(PlainSession):
    """Takes no notice of links that are switched off."""

    def _links_to_ask(self, switched):
        return [link for link in switched if link in self._factor_by_link]


class SessionEqualsGlobalRefresh(TakeTurns):
    def open_session(self):
        return Forgetful(self)


class TablesEqualPlainForm(TakeTurns):
    """Its tables count a link among its own contenders."""

    def tables(self):
        rows = [sorted(near | {link}) for link, near in enumerate(self.near)]
        links = np.array([link for row in rows for link in row], np.int32)
        shares = [ShareRow(lambda stations: 1 / stations)]
        return InterferenceTables(
            starts=np.cumsum([0, *map(len, rows)]),
            links=links,
            is_conflict=np.ones(len(links), np.bool_),
            hidden_units=np.ones(len(links), np.int64),
            limits=[() for _ in rows],
            shares=[shares for _ in rows],
            hidden_factors=[(1.0,) for _ in rows],
        )


class LocalRefreshEqualsGlobal(OutOfReachNothingChanges):
    """Names too few links in reach."""


class SessionsDoNotMeet(TakeTurns):
    def __init__(self, context):
        super().__init__(context)
        self.session = PlainSession(self)

    def open_session(self):
        return self.session


class CompetitionCanBeExplained(TakeTurns):
    def competition(self, links, active):
        return [Competition(self.contenders(link, active) - 1) for link in links]


class OneMoreLinkNeverHelps(TakeTurns):
    def factors(self, links, active):
        counts = [self.contenders(link, active) for link in links]
        return np.array([0.5 if count == 1 else 1.0 for count in counts])


class Relays(ToyRelays):
    """A good model of routes, but for what is planted in it."""

    def __init__(self, context):
        super().__init__(context.network)

    def route_rates(self, routes):
        rates_MBps, bottlenecks = super().route_rates(routes)
        return RouteRates(self.spoilt(rates_MBps, routes), bottlenecks)


class DecidingRoutesIsDeclared(Relays):
    def spoilt(self, rates_MBps, routes):
        return rates_MBps


class RouteRatesFitTheirLinks(Relays):
    def spoilt(self, rates_MBps, routes):
        return rates_MBps * len(routes)


class AloneARouteKeepsItsBandwidth(Relays):
    def spoilt(self, rates_MBps, routes):
        return 0.9 * rates_MBps


class OrderOfRoutesChangesNothing(Relays):
    def spoilt(self, rates_MBps, routes):
        return rates_MBps / np.arange(1, len(routes) + 1)


class RouteRatesHaveNoMemory(Relays):
    """Starts from the answer before, as an iteration does."""

    before_MBps = np.zeros(0)

    def spoilt(self, rates_MBps, routes):
        nudged_MBps = rates_MBps * (1 - 1e-12 * (len(self.before_MBps) % 2))
        self.before_MBps = rates_MBps
        return nudged_MBps


class MovingFewRoutesEqualsMovingAll(Relays):
    """Models of one process know of each other."""

    built = 0

    def __init__(self, context):
        super().__init__(context)
        MovingFewRoutesEqualsMovingAll.built += 1
        self.part = 1 / MovingFewRoutesEqualsMovingAll.built

    def spoilt(self, rates_MBps, routes):
        return self.part * rates_MBps
