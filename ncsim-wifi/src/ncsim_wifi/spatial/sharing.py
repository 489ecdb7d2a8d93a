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
        at_station: dict[int, list[int]] = {}
        for link in self._on_link:
            at_station.setdefault(station[link], []).append(link)
        self._shared = [
            (link, links)
            for links in at_station.values()
            for link in links
            if len(links) > 1 or len(self._on_link[link]) > 1
        ]

    def divide(self, able: Mapping[int, float]) -> list[tuple[float, int]]:
        """Return the rate of each transfer, and the link that decides it.

        Args:
            able: What each link would deliver if its station served no other.
        """
        offers = [{link: able[link] for link in route} for route in self._routes]
        for link, _ in self._shared:
            for number in self._on_link[link]:
                offers[number][link] = math.inf
        for _ in range(ROUNDS if self._shared else 0):
            before = [dict(each) for each in offers]
            demands = {
                link: {n: _least_elsewhere(before[n], link) for n in self._on_link[link]}
                for link, _ in self._shared
            }
            for link, links in self._shared:
                share = self._share_of(link, links, able, demands)
                self._offer(link, share, demands[link], offers)
            if offers == before:
                break
        return [min((value, link) for link, value in each.items()) for each in offers]

    def _share_of(
        self,
        link: int,
        links: Sequence[int],
        able: Mapping[int, float],
        demands: Mapping[int, Mapping[int, float]],
    ) -> float:
        """Return what a station could give one of its links, the others having their demands."""
        if len(links) == 1 or not able[link]:
            return able[link]
        usable = [each for each in links if able[each]]
        asked = [math.inf if each == link else sum(demands[each].values()) for each in usable]
        shares = water_fill(asked, 1.0, [1.0 / able[each] for each in usable])
        return shares[usable.index(link)]

    def _offer(
        self,
        link: int,
        share: float,
        demands: Mapping[int, float],
        offers: Sequence[dict[int, float]],
    ) -> None:
        """Write down what each transfer on a link could take of its share."""
        numbers = self._on_link[link]
        if len(numbers) == 1:
            offers[numbers[0]][link] = share
            return
        for number in numbers:
            asked = [math.inf if each == number else demands[each] for each in numbers]
            parts = water_fill(asked, share, [1.0] * len(numbers))
            offers[number][link] = parts[numbers.index(number)]


def _least_elsewhere(offers: Mapping[int, float], link: int) -> float:
    """Return the least that other links of a route offer."""
    return min((value for at, value in offers.items() if at != link), default=math.inf)
