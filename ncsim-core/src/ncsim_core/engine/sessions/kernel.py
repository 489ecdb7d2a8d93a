"""The inner loops of ``KernelSession``, compiled if numba is there.

Plain functions of arrays, so that they give the same numbers, bit for bit, when they are not
compiled. Only to be imported when kernels are wanted: importing numba takes most of a second.
"""

from collections.abc import Callable
from typing import NamedTuple, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

F = TypeVar("F", bound=Callable[..., object])

IntArray = NDArray[np.int64]
FloatArray = NDArray[np.float64]

STAMP, TOUCHED, LOOKED_AT, CHANGED = range(4)
"""What ``Progress.counters`` count: updates, links whose load moved, how many of these have been
looked at, and how many factors changed."""


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
    """

    starts: IntArray
    affected: NDArray[np.int32]
    is_conflict: NDArray[np.bool_]
    hidden_units: IntArray
    count_shift: int
    limits: IntArray
    share_rows: IntArray
    shares: FloatArray


class Progress(NamedTuple):
    """What changes in a run, and what the last update found.

    Args:
        load: By link.
        factor: By link; has no meaning for inactive links.
        stamps: By link, the last update that touched it; -1 for inactive links.
        touched: The active links whose load moved, and those that became active.
        changed: The links whose factor changed.
        counters: See ``STAMP``.
    """

    load: IntArray
    factor: FloatArray
    stamps: IntArray
    touched: IntArray
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
    """Add what switched links do to the loads of all, and list the active links it is done to.

    Args:
        switched: Links, those that become active first.
        on_count: How many become active.
        arrays: What is added to which.
        progress: Changed.
    """
    load, stamps, touched = progress.load, progress.stamps, progress.touched
    is_conflict, hidden_units = arrays.is_conflict, arrays.hidden_units
    contender = 1 << arrays.count_shift
    stamp = progress.counters[STAMP] + 1
    count = 0
    for k in range(len(switched)):
        stamps[switched[k]] = -1
        if k < on_count:
            stamps[switched[k]] = stamp
            progress.factor[switched[k]] = 1.0
            touched[count] = switched[k]
            count += 1
    for k in range(len(switched)):
        sign = 1 if k < on_count else -1
        for entry in range(arrays.starts[switched[k]], arrays.starts[switched[k] + 1]):
            link = arrays.affected[entry]
            load[link] += sign * (contender if is_conflict[entry] else hidden_units[entry])
            if 0 <= stamps[link] < stamp:
                stamps[link] = stamp
                touched[count] = link
                count += 1
    progress.counters[STAMP], progress.counters[TOUCHED] = stamp, count
    progress.counters[LOOKED_AT], progress.counters[CHANGED] = 0, 0


@compiled
def look_up(arrays: Arrays, progress: Progress) -> bool:
    """Look up the factors of touched links; return whether none is missing from the shares.

    Args:
        arrays: Limits and shares.
        progress: Changed; if a share is missing, ``LOOKED_AT`` counts to the link that needs it.
    """
    load, factor, counters = progress.load, progress.factor, progress.counters
    units_mask = (1 << arrays.count_shift) - 1
    for k in range(counters[LOOKED_AT], counters[TOUCHED]):
        link = progress.touched[k]
        stations = (load[link] >> arrays.count_shift) + 1
        units = load[link] & units_mask
        level = 0
        while arrays.limits[link, level] < units:
            level += 1
        share = arrays.shares[arrays.share_rows[link, level], stations]
        if np.isnan(share):
            counters[LOOKED_AT] = k
            return False
        if share != factor[link]:
            factor[link] = share
            progress.changed[counters[CHANGED]] = link
            counters[CHANGED] += 1
    return True


@compiled
def update(switched: IntArray, on_count: int, arrays: Arrays, progress: Progress) -> bool:
    """Switch links and look factors up in one call; arguments and answer as above."""
    switch_links(switched, on_count, arrays, progress)
    return look_up(arrays, progress)
