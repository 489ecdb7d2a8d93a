"""The incremental form for small networks: one Python number per active link."""

from bisect import bisect_left
from collections.abc import Sequence

from ncsim_core.contracts.interference_model import Competition, InterferenceSession
from ncsim_core.network import LinkIndex
from typing_extensions import override

from ncsim_wifi.influence import Influence
from ncsim_wifi.levels import Levels
from ncsim_wifi.shares import Shares


class RowSession(InterferenceSession):
    """Keeps the load and the factor of every active link.

    Args:
        influence: What each link adds to the loads of others.
        levels: Effective rates under hidden interference.
        shares: Factors by rates and number of stations.
    """

    def __init__(self, influence: Influence, levels: Levels, shares: Shares) -> None:
        self._influence = influence
        self._levels = levels
        self._shares = shares
        self._rows = influence.rows
        self._share_rows = shares.rows_by_level(levels)
        self._count_shift = influence.count_shift
        self._units_mask = influence.units_mask
        self._load: dict[LinkIndex, int] = {}
        self._factor: dict[LinkIndex, float] = {}

    @override
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        for link in off:
            del self._load[link], self._factor[link]
        moved = self._moved([self._rows[i] for i in on], [self._rows[i] for i in off])
        self._welcome(on)
        moved += on
        links, factors = [], []
        for link in moved:
            factor = self._look_up(link)
            if factor != self._factor[link]:
                self._factor[link] = factor
                links.append(link)
                factors.append(factor)
        return links, factors

    def _moved(self, arriving: list[list[int]], leaving: list[list[int]]) -> list[LinkIndex]:
        """Bring the links that stay active up to date; return those whose load moved."""
        loads = self._load
        moved = []
        for link, before in loads.items():
            load = before
            for row in arriving:
                load += row[link]
            for row in leaving:
                load -= row[link]
            if load != before:
                loads[link] = load
                moved.append(link)
        return moved

    def _welcome(self, on: Sequence[LinkIndex]) -> None:
        """Sum up what all active links do to those just switched on."""
        self._load.update(dict.fromkeys(on, 0))
        self._factor.update(dict.fromkeys(on, 1.0))
        rows = [self._rows[link] for link in self._load]
        for link in on:
            self._load[link] = sum([row[link] for row in rows])

    def _look_up(self, link: LinkIndex) -> float:
        load = self._load[link]
        stations = (load >> self._count_shift) + 1
        level = bisect_left(self._levels.limits[link], load & self._units_mask)
        row = self._share_rows[link][level]
        if stations >= len(row):
            rates_Mbps = self._levels.rates_Mbps[link]
            self._shares.grow(row, rates_Mbps[0], rates_Mbps[level], stations)
        return row[stations]

    @override
    def competition(self, links: Sequence[LinkIndex]) -> Sequence[Competition]:
        return [self._competition_of(link) for link in links]

    def _competition_of(self, link: LinkIndex) -> Competition:
        load = self._load[link]
        contenders = self._influence.contenders(load)
        affecting = sum([self._rows[other][link] > 0 for other in self._load])
        return Competition(
            contenders,
            affecting - contenders,
            self._levels.hidden_factor(link, self._influence.hidden_units(load)),
        )
