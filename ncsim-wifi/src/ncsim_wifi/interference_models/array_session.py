"""The incremental form for large networks: arrays over all links.

A link's factor is looked up again only when its load leaves the window in which neither its
level nor its number of contenders changes; so one comparison over all links finds the few
that have to be looked at.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from ncsim_core.contracts.interference_model import Competition, InterferenceSession
from ncsim_core.network import LinkIndex
from typing_extensions import override

from ncsim_wifi.influence import Influence
from ncsim_wifi.levels import Levels
from ncsim_wifi.quantities import IntArray
from ncsim_wifi.shares import Shares

MAX_LINKS_OF_MATRIX = 2500  # 50 MB; adding a whole row is faster than adding to some places
ANYTHING = np.iinfo(np.uint64).max
NOTHING = np.iinfo(np.int64).max
ALL_BITS = -1


class Window(NamedTuple):
    """The loads at which a link's factor stays the same.

    Args:
        mask: Bits of the load that count.
        start: The least such load.
        width: How far above it they reach.
    """

    mask: int
    start: int
    width: int


class ArraySession(InterferenceSession):
    """Keeps the load of every link, and window and factor of every active one.

    Args:
        influence: What each link adds to the loads of others.
        levels: Effective rates under hidden interference.
        shares: Factors by rates and number of stations.
    """

    def __init__(self, influence: Influence, levels: Levels, shares: Shares) -> None:
        count = influence.related.link_count
        self._influence = influence
        self._levels = levels
        self._shares = shares
        self._share_rows = shares.rows_by_level(levels)
        self._matrix = influence.matrix if count <= MAX_LINKS_OF_MATRIX else None
        self._load = np.zeros(count, np.int64)
        self._mask = np.full(count, ALL_BITS)
        self._window_start = np.zeros(count, np.int64)
        self._window_width = np.full(count, ANYTHING)  # so nothing happens to inactive links
        self._factor: dict[LinkIndex, float] = {}

    @override
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        for link in off:
            self._add(link, -1)
            self._window_width[link] = ANYTHING
            del self._factor[link]
        for link in on:
            self._add(link, 1)
            self._mask[link] = ALL_BITS
            self._window_start[link] = NOTHING
            self._window_width[link] = 0
            self._factor[link] = 1.0
        return self._look_up(self._moved())

    def _add(self, link: LinkIndex, sign: int) -> None:
        if self._matrix is None:
            row = self._influence.related.row(link)
            places = self._influence.related.links[row]
            self._load[places] += sign * self._influence.increments[row]
        elif sign > 0:
            self._load += self._matrix[link]
        else:
            self._load -= self._matrix[link]

    def _moved(self) -> IntArray:
        """Return the active links whose load has left its window, in link order.

        Below the window the difference is negative, which as an unsigned number is huge.
        """
        offset = self._load & self._mask
        offset -= self._window_start
        return np.flatnonzero(offset.view(np.uint64) > self._window_width)

    def _look_up(self, moved: IntArray) -> tuple[list[LinkIndex], list[float]]:
        links, factors, windows = [], [], []
        for link, load in zip(moved.tolist(), self._load[moved].tolist(), strict=True):
            factor, window = self._factor_and_window(link, load)
            windows.append(window)
            if factor != self._factor[link]:
                self._factor[link] = factor
                links.append(link)
                factors.append(factor)
        if windows:
            self._mask[moved], self._window_start[moved], self._window_width[moved] = zip(
                *windows, strict=True
            )
        return links, factors

    def _factor_and_window(self, link: LinkIndex, load: int) -> tuple[float, Window]:
        """Return the factor at a load, and the window of loads where it stays the same."""
        influence, limits = self._influence, self._levels.limits[link]
        contenders, hidden_units = influence.contenders(load), influence.hidden_units(load)
        level = self._levels.level(link, hidden_units)
        row = self._share_rows[link][level]
        if contenders + 1 >= len(row):
            rates_Mbps = self._levels.rates_Mbps[link]
            self._shares.grow(row, rates_Mbps[0], rates_Mbps[level], contenders + 1)
        least_units = limits[level - 1] + 1 if level else 0
        if level == len(limits):  # in outage the number of contenders does not matter
            window = Window(influence.units_mask, least_units, influence.units_mask)
        else:
            start = influence.load(contenders, least_units)
            window = Window(ALL_BITS, start, limits[level] - least_units)
        return row[contenders + 1], window

    @override
    def competition(self, links: Sequence[LinkIndex]) -> Sequence[Competition]:
        active = np.fromiter(self._factor, np.int64, len(self._factor))
        return [self._competition_of(link, active) for link in links]

    def _competition_of(self, link: LinkIndex, active: IntArray) -> Competition:
        load = int(self._load[link])
        return Competition(
            self._influence.contenders(load),
            self._influence.interferers(link, active, load),
            self._levels.hidden_factor(link, self._influence.hidden_units(load)),
        )
