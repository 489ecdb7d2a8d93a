"""The definitions by which policies are compared: one place, used by every report.

A run that did not complete has no makespan; it is given as ``None``. It never enters a mean or
a winner set, and every summary says how many were left out.
"""

import math
import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeVar

from ncsim_core.metrics.student_t import t_quantile

TIE_TOLERANCE_s: Final = 1e-6
TIE_TOLERANCE_RATIO: Final = 1e-6

P = TypeVar("P")


def winner_set(makespans_s: Mapping[P, float | None]) -> tuple[P, ...]:
    """Return the policies that tie for the least makespan, in the order of the mapping.

    A policy wins if it is within max(1e-6 s, 1e-6 T) of the least makespan T.

    Source: Section VI-C of the paper (``sec:scheduler_eval``).

    >>> winner_set({"heft": 3.0, "cpop": 3.0000001, "mct": 4.0, "bil": None})
    ('heft', 'cpop')
    """
    completed = [makespan_s for makespan_s in makespans_s.values() if makespan_s is not None]
    if not completed:
        return ()
    least_s = min(completed)
    limit_s = least_s + max(TIE_TOLERANCE_s, TIE_TOLERANCE_RATIO * least_s)
    return tuple(
        policy
        for policy, makespan_s in makespans_s.items()
        if makespan_s is not None and makespan_s <= limit_s
    )


def is_rank_inversion(
    solo_s: Mapping[P, float | None], full_s: Mapping[P, float | None]
) -> bool | None:
    """Return whether no Solo winner wins in Full; ``None`` if one of the modes has no winner.

    Disjoint winner sets: a change of name within a tie is no inversion.

    Source: Section VI-C of the paper (``sec:scheduler_eval``).

    >>> is_rank_inversion({"heft": 3.0, "cpop": 4.0}, {"heft": 9.0, "cpop": 8.0})
    True
    """
    solo, full = winner_set(solo_s), winner_set(full_s)
    return not set(solo) & set(full) if solo and full else None


def solo_choice(solo_s: Mapping[P, float | None], order: Sequence[P] | None = None) -> P | None:
    """Return the policy that Solo would select: the first of its winners in a stated order.

    Args:
        solo_s: Solo makespans by policy.
        order: The order of preference among tied policies; by default that of the mapping.
    """
    winners = winner_set(solo_s)
    return next((policy for policy in order or tuple(solo_s) if policy in winners), None)


def regret(
    solo_s: Mapping[P, float | None],
    full_s: Mapping[P, float | None],
    order: Sequence[P] | None = None,
) -> float | None:
    """Return what choosing by Solo costs in Full, relative to the best choice.

    ``None`` if Solo selects nothing or its choice does not complete in Full.

    Source: the paper's Eq. ``eq:regret``.

    >>> regret({"heft": 3.0, "cpop": 4.0}, {"heft": 12.0, "cpop": 8.0})
    0.5
    """
    choice = solo_choice(solo_s, order)
    return None if choice is None else regret_of(choice, full_s)


def regret_of(policy: P, makespans_s: Mapping[P, float | None]) -> float | None:
    """Return what a policy costs relative to the best: T / min T - 1.

    ``None`` if it did not complete.

    >>> regret_of("heft", {"heft": 12.0, "cpop": 8.0})
    0.5
    """
    ratio = ratios_to_best(makespans_s).get(policy)
    return None if ratio is None else ratio - 1


def ratios_to_best(makespans_s: Mapping[P, float | None]) -> dict[P, float | None]:
    """Return each makespan over the least; the rows of the paper's ``tab:winner_matrix``."""
    completed = [makespan_s for makespan_s in makespans_s.values() if makespan_s is not None]
    return {
        policy: None if makespan_s is None else _ratio(makespan_s, min(completed))
        for policy, makespan_s in makespans_s.items()
    }


def slowdown(full_s: float | None, solo_s: float | None) -> float | None:
    """Return the Full over the Solo makespan; ``None`` if either is missing.

    >>> slowdown(9.0, 3.0)
    3.0
    """
    return None if full_s is None or solo_s is None else _ratio(full_s, solo_s)


def _ratio(numerator: float, denominator: float) -> float:
    """Return a quotient of makespans; 1 if both are zero."""
    if denominator == 0:
        return 1.0 if numerator == 0 else math.inf
    return numerator / denominator


@dataclass(frozen=True)
class MeanInterval:
    """A mean with its confidence interval.

    Args:
        mean: ``None`` if there was no value.
        low: Lower end; ``None`` with fewer than two values.
        high: Upper end, likewise.
        count: Values that entered.
        left_out: Missing values that did not.
    """

    mean: float | None
    low: float | None
    high: float | None
    count: int
    left_out: int


def mean_interval(values: Iterable[float | None], confidence: float = 0.95) -> MeanInterval:
    """Return the mean and its Student-t interval: mean +- t(n - 1) s / sqrt(n).

    Args:
        values: One per replication; ``None`` where a run did not complete.
        confidence: Between 0 and 1.

    >>> interval = mean_interval([1.0, 2.0, 3.0, None])
    >>> interval.mean, round(interval.high, 4), interval.left_out
    (2.0, 4.4841, 1)
    """
    present, left_out = _present(values)
    count = len(present)
    if count == 0:
        return MeanInterval(None, None, None, 0, left_out)
    mean = math.fsum(present) / count
    if count == 1:
        return MeanInterval(mean, None, None, 1, left_out)
    margin = t_quantile((1 + confidence) / 2, count - 1) * statistics.stdev(present)
    half_width = margin / math.sqrt(count)
    return MeanInterval(mean, mean - half_width, mean + half_width, count, left_out)


@dataclass(frozen=True)
class Median:
    """A median, ``None`` if there was no value; how many entered and how many did not."""

    median: float | None
    count: int
    left_out: int


def median(values: Iterable[float | None]) -> Median:
    """Return the median of the values that are there.

    >>> median([1.0, None, 3.0])
    Median(median=2.0, count=2, left_out=1)
    """
    present, left_out = _present(values)
    return Median(statistics.median(present) if present else None, len(present), left_out)


def paired_differences(
    first: Sequence[float | None], second: Sequence[float | None]
) -> list[float | None]:
    """Return second minus first for each pair; ``None`` unless both completed.

    Feed it to ``mean_interval``: pairs see the same draws, so their differences vary less.

    Raises:
        ValueError: The sequences are not equally long.

    >>> paired_differences([1.0, 2.0, None], [1.5, 4.0, 9.0])
    [0.5, 2.0, None]
    """
    return [
        None if one is None or other is None else other - one
        for one, other in zip(first, second, strict=True)
    ]


def _present(values: Iterable[float | None]) -> tuple[list[float], int]:
    listed = list(values)
    present = [value for value in listed if value is not None]
    return present, len(listed) - len(present)
