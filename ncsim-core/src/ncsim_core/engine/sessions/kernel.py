"""The inner loops of ``KernelSession``, compiled if numba is there.

Plain functions of arrays, so that they give the same numbers, bit for bit, when they are not
compiled. Only to be imported when kernels are wanted: starting numba takes more than a second.
"""

from collections.abc import Callable
from typing import NamedTuple, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

F = TypeVar("F", bound=Callable[..., object])

IntArray = NDArray[np.int64]
FloatArray = NDArray[np.float64]

LOOKED_AT, CHANGED = range(2)
"""What ``Progress.counters`` count: links that have been looked at, and factors that changed."""

ALL_BITS = -1
NOTHING = np.iinfo(np.int64).max
ANYTHING = np.iinfo(np.uint64).max


class Arrays(NamedTuple):
    """Tables as arrays; ``shares`` is filled as it comes up.

    Args:
        starts: Where rows begin.
        affected: Links affected, row by row.
        is_conflict: Whether they get another contender, or hidden power.
        hidden_units: How much.
        count_shift: How many bits of a load the hidden sum has.
        limits: By link and level, the greatest hidden sum; the greatest number after the last.
        share_rows: By link and level, the row in ``shares``.
        shares: Factors by row and number of stations; not a number where not worked out yet.
        is_constant: By row of ``shares``, whether the number of stations does not matter.
    """

    starts: IntArray
    affected: NDArray[np.int32]
    is_conflict: NDArray[np.bool_]
    hidden_units: IntArray
    count_shift: int
    limits: IntArray
    share_rows: IntArray
    shares: FloatArray
    is_constant: NDArray[np.bool_]


class Progress(NamedTuple):
    """What changes in a run, by link, and what the last update found.

    A factor is looked up again only when the load, as far as ``mask`` lets it count, leaves the
    window in which neither level nor number of contenders changes.

    Args:
        load: Contenders and hidden sum.
        factor: Has no meaning for inactive links.
        mask: Bits of the load that count.
        start: Where the window begins.
        width: How far above it the window reaches; anything for inactive links.
        changed: The links whose factor changed, from the front.
        counters: See ``LOOKED_AT``.
    """

    load: IntArray
    factor: FloatArray
    mask: IntArray
    start: IntArray
    width: NDArray[np.uint64]
    changed: IntArray
    counters: IntArray


def compiled(function: F) -> F:
    """Return a function compiled, kept on disk where that is possible; as it is without numba."""
    try:
        import numba
    except ImportError:
        return function
    try:
        return cast("F", numba.njit(cache=True)(function))
    except RuntimeError:  # no folder to keep it in
        return cast("F", numba.njit(function))


@compiled
def switch_links(switched: IntArray, on_count: int, arrays: Arrays, progress: Progress) -> None:
    """Add what switched links do to the loads of all, and open or close their windows.

    Args:
        switched: Links, those that become active first.
        on_count: How many become active.
        arrays: What is added to which.
        progress: Changed.
    """
    is_conflict, hidden_units = arrays.is_conflict, arrays.hidden_units
    contender = 1 << arrays.count_shift
    for k in range(len(switched)):
        link, sign = switched[k], -1
        progress.width[link] = ANYTHING
        if k < on_count:
            sign = 1
            progress.factor[link] = 1.0
            progress.mask[link], progress.start[link] = ALL_BITS, NOTHING
            progress.width[link] = 0
        for entry in range(arrays.starts[link], arrays.starts[link + 1]):
            increment = contender if is_conflict[entry] else hidden_units[entry]
            progress.load[arrays.affected[entry]] += sign * increment
    progress.counters[LOOKED_AT], progress.counters[CHANGED] = 0, 0


@compiled
def look_up(arrays: Arrays, progress: Progress) -> bool:
    """Look up the factors of links outside their window; return whether none is missing.

    Args:
        arrays: Limits and shares.
        progress: Changed; if a share is missing, ``LOOKED_AT`` is the link that needs it.
    """
    load, counters = progress.load, progress.counters
    for link in range(counters[LOOKED_AT], len(load)):
        offset = (load[link] & progress.mask[link]) - progress.start[link]
        if np.uint64(offset) <= progress.width[link]:  # below the window it is huge
            continue
        level = level_of(link, arrays, progress)
        row = arrays.share_rows[link, level]
        share = arrays.shares[row, (load[link] >> arrays.count_shift) + 1]
        if np.isnan(share):
            counters[LOOKED_AT] = link
            return False
        open_window(link, level, arrays, progress)
        if share != progress.factor[link]:
            progress.factor[link] = share
            progress.changed[counters[CHANGED]] = link
            counters[CHANGED] += 1
    return True


@compiled
def level_of(link: int, arrays: Arrays, progress: Progress) -> int:
    """Return the level of a link."""
    units = progress.load[link] & ((1 << arrays.count_shift) - 1)
    level = 0
    while arrays.limits[link, level] < units:
        level += 1
    return level


@compiled
def open_window(link: int, level: int, arrays: Arrays, progress: Progress) -> None:
    """Set the window of a link to the loads at which it stays as it is."""
    units_mask = (1 << arrays.count_shift) - 1
    least = 0 if level == 0 else arrays.limits[link, level - 1] + 1
    progress.width[link] = min(arrays.limits[link, level], units_mask) - least
    if arrays.is_constant[arrays.share_rows[link, level]]:
        progress.mask[link], progress.start[link] = units_mask, least
    else:
        contenders = progress.load[link] & ~units_mask
        progress.mask[link], progress.start[link] = ALL_BITS, contenders + least


@compiled
def update(switched: IntArray, on_count: int, arrays: Arrays, progress: Progress) -> bool:
    """Switch links and look factors up in one call; arguments and answer as above."""
    switch_links(switched, on_count, arrays, progress)
    return look_up(arrays, progress)
