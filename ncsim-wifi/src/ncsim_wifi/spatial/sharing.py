"""How stations divide what they can deliver among the transfers that pass them.

A station serves its links in turn, a link its transfers; who is held up elsewhere leaves the rest
to others (max-min fairness, Bertsekas and Gallager, Data Networks, 6.5.2).
"""

import math
from collections.abc import Mapping, Sequence

ROUNDS = 6


def greedy_shares(
    demands: Sequence[float], costs: Sequence[float], capacity: float = 1.0
) -> list[float]:
    """Return for each what it would get of a capacity if it took all it can get.

    The others get equal shares, less if they demand less.

    Args:
        demands: The most that each takes as one of the others.
        costs: What one unit costs each.
        capacity: What there is.

    >>> greedy_shares([0.2, 0.0, 0.9], [1.0, 1.0, 1.0])
    [0.5, 0.4, 0.8]
    """
    order = sorted(range(len(demands)), key=demands.__getitem__)
    cost = sum(costs)
    shares = [0.0] * len(demands)
    for at, greedy in enumerate(order):  # those before it have been served
        left, left_cost = capacity, cost
        for place in order[at + 1 :]:
            demand = demands[place]
            if demand == math.inf and place > greedy:
                continue
            level = max(0.0, left) / left_cost if left_cost > 0.0 else 0.0
            left -= min(demand, level) * costs[place]
            left_cost -= costs[place]
        shares[greedy] = max(0.0, left) / left_cost if left_cost > 0.0 else 0.0
        level = max(0.0, capacity) / cost if cost > 0.0 else 0.0
        capacity -= min(demands[greedy], level) * costs[greedy]
        cost -= costs[greedy]
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
            (links, {number for link in links for number in self._on_link[link]})
            for links in at_station.values()
            if len(links) > 1 or len(self._on_link[links[0]]) > 1
        ]

    def divide(self, able: Mapping[int, float]) -> list[tuple[float, int]]:
        """Return the rate of each transfer, and the link that decides it.

        Args:
            able: What each link would deliver if its station served no other.
        """
        offers = [{link: able[link] for link in route} for route in self._routes]
        for links, _ in self._shared:
            for link in links:
                for number in self._on_link[link]:
                    offers[number][link] = math.inf
        before: list[tuple[float, int, float]] = []
        for _ in range(ROUNDS if self._shared else 0):
            least = [_two_least(each) for each in offers]
            moved = {at for at, each in enumerate(least) if not before or each != before[at]}
            before = least
            for links, numbers in self._shared:
                if not moved.isdisjoint(numbers):  # else it would offer the same again
                    self._serve(links, able, least, offers)
            if not moved:
                break
        return [min((value, link) for link, value in each.items()) for each in offers]

    def _serve(
        self,
        links: Sequence[int],
        able: Mapping[int, float],
        least: Sequence[tuple[float, int, float]],
        offers: Sequence[dict[int, float]],
    ) -> None:
        """Write down what one station offers the transfers on its links."""
        demands = {
            link: [
                second if link == tightest else first
                for first, tightest, second in (least[number] for number in self._on_link[link])
            ]
            for link in links
        }
        if len(links) == 1:
            self._offer(links[0], able[links[0]], demands[links[0]], offers)
            return
        usable = [link for link in links if able[link]]
        asked = [sum(demands[link]) for link in usable]
        shares = greedy_shares(asked, [1.0 / able[link] for link in usable])
        share = dict(zip(usable, shares, strict=True))
        for link in links:
            self._offer(link, share.get(link, 0.0), demands[link], offers)

    def _offer(
        self,
        link: int,
        share: float,
        demands: Sequence[float],
        offers: Sequence[dict[int, float]],
    ) -> None:
        """Write down what each transfer on a link could take of its share."""
        numbers = self._on_link[link]
        if len(numbers) == 1:
            offers[numbers[0]][link] = share
            return
        ones = [1.0] * len(numbers)
        for number, offer in zip(numbers, greedy_shares(demands, ones, share), strict=True):
            offers[number][link] = offer


def _two_least(offers: Mapping[int, float]) -> tuple[float, int, float]:
    """Return the least offer and its link, and the least of all other links."""
    first, tightest, second = math.inf, -1, math.inf
    for link, value in offers.items():
        if value < first:
            first, tightest, second = value, link, first
        elif value < second:
            second = value
    return first, tightest, second
