"""Factors of links under an interference model that is given as tables.

Contenders and hidden sum of a link are one number, its *load* (``sessions/loads.py``). A factor is
looked up again only when the load, as far as ``mask`` lets it count, leaves the window in which
neither level nor number of contenders changes.
"""

from math import isnan
from typing import Final

import numpy as np

from ncsim_core.compiling import inlined
from ncsim_core.engine.compiled.layout import (
    affected_link_at,
    changed_at,
    conflict_at,
    hidden_at,
    level_at,
    link_at,
    load_at,
    row_at,
    share_at,
    switched_at,
    vector_at,
    window_at,
)
from ncsim_core.engine.compiled.records import Record

ALL_BITS: Final = -1
NOTHING: Final = np.iinfo(np.int64).max
ANYTHING: Final = np.iinfo(np.uint64).max


@inlined
def switch_links(count: int, sign: int, state: Record) -> None:
    """Add what switched links do to the loads of all, and open or close their windows.

    Args:
        count: How many have been switched.
        sign: 1 if they become active, -1 if idle.
        state: Changed.
    """
    for k in range(count):
        link = switched_at(k, state).number
        window = window_at(link, state)
        if sign > 0:
            window.mask, window.start, window.width = ALL_BITS, NOTHING, 0
        else:
            window.width = ANYTHING
        if state.has_matrix:
            add_row(link, sign, state)
        else:
            add_entries(link, sign, state)
    state.looked_up = state.changed_count = 0
    if state.shows_rates:
        switch_heard(count, sign, state)


@inlined
def add_row(link: int, sign: int, state: Record) -> None:
    """Add what a link does to the loads of all: many at a time, those of no effect too."""
    count = state.link_count
    loads = vector_at(state.loads, count)
    row = vector_at(state.matrix + link * count * 8, count)
    if sign > 0:
        for other in range(count):
            loads[other] += row[other]
    else:
        for other in range(count):
            loads[other] -= row[other]


@inlined
def add_entries(link: int, sign: int, state: Record) -> None:
    """Add what a link does to the loads of those that it affects."""
    contender = 1 << state.count_shift
    for at in range(row_at(link, state).number, row_at(link + 1, state).number):
        increment = contender if conflict_at(at, state).is_conflict else hidden_at(at, state).units
        load_at(affected_link_at(at, state).link, state).number += sign * increment


@inlined
def switch_heard(count: int, sign: int, state: Record) -> None:
    """Count the active links that affect each link."""
    for k in range(count):
        link = switched_at(k, state).number
        for at in range(row_at(link, state).number, row_at(link + 1, state).number):
            link_at(affected_link_at(at, state).link, state).heard += sign


@inlined
def look_up(state: Record) -> bool:
    """Look up the factors of links outside their window; return whether none is missing.

    If a share is missing, ``looked_up`` is the link that needs it.
    """
    for link in range(state.looked_up, state.link_count):
        window = window_at(link, state)
        offset = (load_at(link, state).number & window.mask) - window.start
        if np.uint64(offset) <= window.width:  # below the window it is huge
            continue
        level = level_of(link, state)
        factor = share_of(link, level, state)
        if isnan(factor):
            state.looked_up = link
            return False
        open_window(link, level, state)
        if factor != link_at(link, state).factor:
            link_at(link, state).factor = factor
            changed_at(state.changed_count, state).number = link
            state.changed_count += 1
    state.looked_up = state.link_count  # until links are switched again
    return True


@inlined
def level_of(link: int, state: Record) -> int:
    """Return the level of a link."""
    units = load_at(link, state).number & ((1 << state.count_shift) - 1)
    level = 0
    while level_at(link * state.level_count + level, state).limit < units:
        level += 1
    return level


@inlined
def share_of(link: int, level: int, state: Record) -> float:
    """Return the factor of a link; not a number where it has not been worked out yet."""
    stations = (load_at(link, state).number >> state.count_shift) + 1
    row = level_at(link * state.level_count + level, state).share_row
    factor: float = share_at(row * state.share_count + stations, state).factor
    return factor


@inlined
def open_window(link: int, level: int, state: Record) -> None:
    """Set the window of a link to the loads at which it stays as it is."""
    units_mask = (1 << state.count_shift) - 1
    window, at = window_at(link, state), level_at(link * state.level_count + level, state)
    least = 0
    if level > 0:
        least = level_at(link * state.level_count + level - 1, state).limit + 1
    window.width = min(at.limit, units_mask) - least
    if at.is_constant:
        window.mask, window.start = units_mask, least
    else:
        window.mask, window.start = ALL_BITS, (load_at(link, state).number & ~units_mask) + least
