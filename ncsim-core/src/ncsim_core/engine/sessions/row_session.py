"""The session for small networks: one Python number per active link."""

from bisect import bisect_left
from collections.abc import Sequence

from typing_extensions import override

from ncsim_core.engine.sessions.loads import Loads
from ncsim_core.engine.sessions.tabled_session import TabledSession
from ncsim_core.network import LinkIndex


class RowSession(TabledSession):
    """Keeps the load and the factor of every active link.

    Args:
        loads: The tables, as numbers to add.
    """

    def __init__(self, loads: Loads) -> None:
        super().__init__(loads)
        self._rows = loads.rows
        self._limits = loads.tables.limits
        self._shares = loads.tables.shares
        self._load: dict[LinkIndex, int] = {}
        self._factor: dict[LinkIndex, float] = {}

    @override
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        self._toggle(on, off)
        for link in off:
            del self._load[link], self._factor[link]
        moved = self._moved([self._rows[i] for i in on], [self._rows[i] for i in off])
        self._welcome(on)
        moved += on
        return self._look_up(moved)

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

    def _look_up(self, moved: Sequence[LinkIndex]) -> tuple[list[LinkIndex], list[float]]:
        count_shift, units_mask = self._loads.count_shift, self._loads.units_mask
        loads, factors, limits, shares = self._load, self._factor, self._limits, self._shares
        links, changed = [], []
        for link in moved:
            load = loads[link]
            level = bisect_left(limits[link], load & units_mask)
            factor = shares[link][level].factor((load >> count_shift) + 1)
            if factor != factors[link]:
                factors[link] = factor
                links.append(link)
                changed.append(factor)
        return links, changed

    @override
    def _loads_of(self, links: Sequence[LinkIndex]) -> list[int]:
        return [self._load[link] for link in links]
