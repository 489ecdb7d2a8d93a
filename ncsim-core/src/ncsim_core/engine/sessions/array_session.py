"""The session for large networks: arrays over all links.

A link's factor is looked up again only when its load leaves the window in which neither its
level nor its number of contenders changes; so one comparison over all links finds the few
that have to be looked at.
"""

from bisect import bisect_left
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from ncsim_core.engine.sessions.loads import Loads
from ncsim_core.engine.sessions.tabled_session import TabledSession
from ncsim_core.network import LinkIndex

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


class ArraySession(TabledSession):
    """Keeps the load of every link, and window and factor of every active one.

    Args:
        loads: The tables, as numbers to add.
    """

    def __init__(self, loads: Loads) -> None:
        super().__init__(loads)
        count = loads.tables.link_count
        self._tables = loads.tables
        self._matrix = loads.matrix if count <= MAX_LINKS_OF_MATRIX else None
        self._load = np.zeros(count, np.int64)
        self._mask = np.full(count, ALL_BITS)
        self._window_start = np.zeros(count, np.int64)
        self._window_width = np.full(count, ANYTHING)  # so nothing happens to inactive links
        self._factor: dict[LinkIndex, float] = {}

    @override
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        self._toggle(on, off)
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
            row = slice(int(self._tables.starts[link]), int(self._tables.starts[link + 1]))
            self._load[self._tables.links[row]] += sign * self._loads.increments(row)
        elif sign > 0:
            self._load += self._matrix[link]
        else:
            self._load -= self._matrix[link]

    def _moved(self) -> "NDArray[np.intp]":
        """Return the active links whose load has left its window, in link order.

        Below the window the difference is negative, which as an unsigned number is huge.
        """
        offset = self._load & self._mask
        offset -= self._window_start
        moved: NDArray[np.intp] = np.flatnonzero(offset.view(np.uint64) > self._window_width)
        return moved

    def _look_up(self, moved: "NDArray[np.intp]") -> tuple[list[LinkIndex], list[float]]:
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
        count_shift, units_mask = self._loads.count_shift, self._loads.units_mask
        limits = self._tables.limits[link]
        contenders = load >> count_shift
        level = bisect_left(limits, load & units_mask)
        share_row = self._tables.shares[link][level]
        least_units = limits[level - 1] + 1 if level else 0
        most_units = min(limits[level], units_mask) if level < len(limits) else units_mask
        width = most_units - least_units
        if share_row.is_constant:  # the number of contenders does not matter
            window = Window(units_mask, least_units, width)
        else:
            window = Window(ALL_BITS, (contenders << count_shift) + least_units, width)
        return share_row.factor(contenders + 1), window

    @override
    def _loads_of(self, links: Sequence[LinkIndex]) -> list[int]:
        loads: list[int] = self._load[[*links]].tolist()
        return loads
