"""How stations divide what they can deliver among the transfers that pass them.

A station serves its links in turn, a link its transfers; who is held up elsewhere leaves the rest
to others (max-min fairness, Bertsekas and Gallager, Data Networks, 6.5.2).
"""

import math
from collections.abc import Mapping, Sequence

ROUNDS = 6


def water_fill(demands: Sequence[float], capacity: float, costs: Sequence[float]) -> list[float]:
    """Return equal shares of a capacity, less for those who demand less.

    Args:
        demands: The most that each takes.
        capacity: What there is.
        costs: What one unit costs each.

    >>> water_fill([1.0, 5.0, 9.0], 10.0, [1.0, 1.0, 1.0])
    [1.0, 4.5, 4.5]
    """
    shares = [0.0] * len(demands)
    waiting = sorted(range(len(demands)), key=demands.__getitem__)
    cost = sum(costs)
    for place in waiting:
        level = max(0.0, capacity) / cost if cost > 0.0 else 0.0
        shares[place] = min(demands[place], level)
        capacity -= shares[place] * costs[place]
        cost -= costs[place]
    return shares


class Sharing:
    """Who passes which links and stations.

    Args:
        routes: Links of each transfer.
        station: Station of each link.
    """

    def __init__(self, routes: Sequence[Sequence[int]], station: Mapping[int, int]) -> None:
        self._routes = routes
        self._on_link: dict[int, list[int]] = {}
        for number, route in enumerate(routes):
            for link in route:
                self._on_link.setdefault(link, []).append(number)
        self._at_station: dict[int, list[int]] = {}
        for link in self._on_link:
            self._at_station.setdefault(station[link], []).append(link)

    def divide(self, able: Mapping[int, float]) -> list[tuple[float, int]]:
        """Return the rate of each transfer, and the link that decides it.

        Args:
            able: What each link would deliver if its station served no other.
        """
        offers = [dict.fromkeys(route, math.inf) for route in self._routes]
        for _ in range(ROUNDS):
            demands = [{link: _least_elsewhere(each, link) for link in each} for each in offers]
            for links in self._at_station.values():
                for link in links:
                    share = self._share_of(link, links, able, demands)
                    self._offer(link, share, demands, offers)
        return [min((value, link) for link, value in each.items()) for each in offers]

    def _share_of(
        self,
        link: int,
        links: Sequence[int],
        able: Mapping[int, float],
        demands: Sequence[Mapping[int, float]],
    ) -> float:
        """Return what a station could give one of its links, the others having their demands."""
        if not able[link]:
            return 0.0
        usable = [each for each in links if able[each]]
        asked = [
            math.inf if each == link else sum(demands[n][each] for n in self._on_link[each])
            for each in usable
        ]
        shares = water_fill(asked, 1.0, [1.0 / able[each] for each in usable])
        return shares[usable.index(link)]

    def _offer(
        self,
        link: int,
        share: float,
        demands: Sequence[Mapping[int, float]],
        offers: Sequence[dict[int, float]],
    ) -> None:
        """Write down what each transfer on a link could take of its share."""
        numbers = self._on_link[link]
        for number in numbers:
            asked = [math.inf if each == number else demands[each][link] for each in numbers]
            parts = water_fill(asked, share, [1.0] * len(numbers))
            offers[number][link] = parts[numbers.index(number)]


def _least_elsewhere(offers: Mapping[int, float], link: int) -> float:
    """Return the least that other links of a route offer."""
    return min((value for at, value in offers.items() if at != link), default=math.inf)
