"""An interference model's tables as the records of the compiled loop."""

from bisect import bisect_left
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ncsim_core.contracts.interference_tables import ShareRow
from ncsim_core.engine.compiled import layout
from ncsim_core.engine.compiled.arrays import Arrays, records
from ncsim_core.engine.compiled.radio import ANYTHING
from ncsim_core.engine.compiled.records import Record
from ncsim_core.engine.sessions.array_session import MAX_LINKS_OF_MATRIX
from ncsim_core.engine.sessions.loads import Loads

NO_MATRIX = np.zeros((0, 0), np.int64)
GREATEST = np.iinfo(np.int64).max


class _Prepared(NamedTuple):
    """What all runs share that share tables: records by name, and the distinct rows of shares."""

    arrays: dict[str, Record]
    rows: list[ShareRow]
    level_count: int


class Radio:
    """The radio of one run.

    Args:
        loads: The tables, as numbers to add.
        arrays: Of the run; the radio's are put in.
    """

    def __init__(self, loads: Loads, arrays: Arrays) -> None:
        self._loads = loads
        self._prepared = _prepared(loads)
        self._arrays = arrays
        count, state = loads.tables.link_count, arrays.state
        arrays.put_all(self._prepared.arrays)
        arrays.put("loads", np.zeros(count, np.int64))
        arrays.put("windows", records(count, layout.WINDOW, width=ANYTHING))
        arrays.put("changed", np.zeros(count, np.int64))
        state.has_radio, state.count_shift = 1, loads.count_shift
        state.has_matrix = len(arrays["matrix"]) > 0
        state.link_count = state.looked_up = count
        state.level_count, state.share_count = self._prepared.level_count, _stations(loads)

    def fill_missing_share(self) -> None:
        """Work out the share at which the loop stopped."""
        loads, state = self._loads, self._arrays.state
        link = int(state.looked_up)
        load = int(self._arrays["loads"][link])
        stations = (load >> loads.count_shift) + 1
        level = bisect_left(loads.tables.limits[link], load & loads.units_mask)
        row = int(self._arrays["levels"].share_row[link * state.level_count + level])
        factor = self._prepared.rows[row].factor(stations)
        self._arrays["shares"].factor[row * state.share_count + stations] = factor


def _stations(loads: Loads) -> int:
    """Return the shares in a row: from no station to more than a link can hear."""
    return loads.most_contenders + 2


def _prepared(loads: Loads) -> _Prepared:
    tables = loads.tables
    known = tables.kept.get("compiled")
    if isinstance(known, _Prepared):
        return known
    rows = list({id(row): row for rows in tables.shares for row in rows}.values())
    level_count = max(map(len, tables.shares), default=1)
    arrays: dict[str, Record] = {
        "rows": np.ascontiguousarray(tables.starts, np.int64),
        "affected_links": np.ascontiguousarray(tables.links, np.int32),
        "conflicts": np.ascontiguousarray(tables.is_conflict, np.bool_),
        "hidden": np.ascontiguousarray(tables.hidden_units, np.int64),
        "matrix": loads.matrix if tables.link_count <= MAX_LINKS_OF_MATRIX else NO_MATRIX,
        "levels": _levels(loads, rows, level_count),
        "shares": records(len(rows) * _stations(loads), layout.ARRAYS["shares"], factor=np.nan),
    }
    prepared = tables.kept["compiled"] = _Prepared(arrays, rows, level_count)
    return prepared


def _levels(loads: Loads, rows: Sequence[ShareRow], level_count: int) -> Record:
    """Return the levels link by link, the last of each repeated."""
    place = {id(row): number for number, row in enumerate(rows)}
    levels = records(loads.tables.link_count * level_count, layout.LEVEL, limit=GREATEST)
    by_link = levels.reshape(loads.tables.link_count, level_count)
    for link, (limits, shares) in enumerate(
        zip(loads.tables.limits, loads.tables.shares, strict=True)
    ):
        by_link.limit[link, : len(limits)] = limits
        by_link.share_row[link, : len(shares)] = [place[id(row)] for row in shares]
        by_link.is_constant[link, : len(shares)] = [row.is_constant for row in shares]
    return levels
