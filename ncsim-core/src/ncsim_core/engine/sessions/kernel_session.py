"""The session for long runs: everything in arrays, the loops over them compiled."""

from bisect import bisect_left
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from ncsim_core.contracts.interference_tables import InterferenceTables, ShareRow
from ncsim_core.engine.sessions import kernel
from ncsim_core.engine.sessions.loads import Loads
from ncsim_core.engine.sessions.tabled_session import TabledSession
from ncsim_core.network import LinkIndex

GREATEST = np.iinfo(np.int64).max


class KernelSession(TabledSession):
    """Keeps loads and factors of all links in arrays that the kernels change.

    Args:
        loads: The tables, as numbers to add.
    """

    def __init__(self, loads: Loads) -> None:
        super().__init__(loads)
        count = loads.tables.link_count
        self._rows, self._arrays = _prepared(loads)
        self._progress = kernel.Progress(
            load=np.zeros(count, np.int64),
            factor=np.ones(count),
            mask=np.zeros(count, np.int64),
            start=np.zeros(count, np.int64),
            width=np.full(count, kernel.ANYTHING, np.uint64),
            changed=np.zeros(count, np.int64),
            counters=np.zeros(2, np.int64),
        )

    @override
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        self._toggle(on, off)
        progress = self._progress
        switched = np.array((*on, *off), np.int64)
        is_complete = kernel.update(switched, len(on), self._arrays, progress)
        while not is_complete:
            self._fill_missing_share()
            is_complete = kernel.look_up(self._arrays, progress)
        links = progress.changed[: progress.counters[kernel.CHANGED]]
        return links.tolist(), progress.factor[links].tolist()

    def _fill_missing_share(self) -> None:
        """Work out the share at which the kernel stopped."""
        link = int(self._progress.counters[kernel.LOOKED_AT])
        (load,) = self._loads_of([link])
        stations = (load >> self._loads.count_shift) + 1
        level = bisect_left(self._loads.tables.limits[link], load & self._loads.units_mask)
        row = self._arrays.share_rows[link, level]
        self._arrays.shares[row, stations] = self._rows[row].factor(stations)

    @override
    def _loads_of(self, links: Sequence[LinkIndex]) -> list[int]:
        loads: list[int] = self._progress.load[list(links)].tolist()
        return loads


class _Prepared(NamedTuple):
    """Tables as the kernels want them, and the distinct rows of shares."""

    rows: list[ShareRow]
    arrays: kernel.Arrays


def _prepared(loads: Loads) -> _Prepared:
    """Return what is made once for all runs that share tables."""
    tables = loads.tables
    known = tables.kept.get("kernel")
    if isinstance(known, _Prepared):
        return known
    rows = list({id(row): row for rows in tables.shares for row in rows}.values())
    arrays = kernel.Arrays(
        starts=tables.starts,
        affected=tables.links,
        is_conflict=tables.is_conflict,
        hidden_units=tables.hidden_units,
        count_shift=loads.count_shift,
        limits=_padded([(*each, GREATEST) for each in tables.limits]),
        share_rows=_share_rows(tables, rows),
        shares=np.full((len(rows), loads.most_contenders + 2), np.nan),
        is_constant=np.array([row.is_constant for row in rows], np.bool_),
    )
    tables.kept["kernel"] = prepared = _Prepared(rows, arrays)
    return prepared


def _share_rows(tables: InterferenceTables, rows: Sequence[ShareRow]) -> NDArray[np.int64]:
    """Return by link and level the place of its row of shares."""
    place = {id(row): number for number, row in enumerate(rows)}
    return _padded([tuple(place[id(row)] for row in each) for each in tables.shares])


def _padded(rows: Sequence[tuple[int, ...]]) -> NDArray[np.int64]:
    """Return rows of different lengths as an array, the last number of each repeated."""
    width = max(map(len, rows), default=1)
    return np.array([(*row, *row[-1:] * (width - len(row))) for row in rows], np.int64).reshape(
        len(rows), width
    )
