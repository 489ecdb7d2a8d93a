"""Time inside the engine, and every conversion to and from it.

An ``Instant`` is a whole number of microseconds since the start of the run, so that equal
means equal. Seconds appear only at the edges: scenario files, metrics, messages.
"""

from math import ceil
from typing import TypeAlias

Instant: TypeAlias = int

MICROSECONDS_PER_SECOND = 1_000_000
COMPLETION_TOLERANCE_us = 1e-5
"""Slack before rounding a completion up, so that an exact end is not pushed one tick on."""

HORIZON_us: Instant = 9_000_000_000 * MICROSECONDS_PER_SECOND
"""No run goes on longer than this (285 years): beyond it a float no longer tells microseconds."""
BEYOND_us: Instant = HORIZON_us + 1
"""What stands for every later instant."""
NEVER_us: Instant = 2**62
"""Later than any instant that the engine can reckon with."""

MEGABITS_PER_MEGABYTE = 8.0
MAX_QUANTITY = 1e100
"""No cost, size, speed or latency is larger, so that no sum of them leaves the numbers."""


def is_quantity(value: float) -> bool:
    """Return whether a cost, size, speed or latency lies between 0 and ``MAX_QUANTITY``.

    >>> is_quantity(0.0), is_quantity(-1.0), is_quantity(float("inf")), is_quantity(float("nan"))
    (True, False, False, False)
    """
    return 0 <= value <= MAX_QUANTITY


def us_from_s(seconds: float) -> Instant:
    """Return the microsecond nearest to ``seconds`` (ties to even), at most ``BEYOND_us``.

    >>> us_from_s(500 / 300)
    1666667
    """
    exact_us = seconds * MICROSECONDS_PER_SECOND
    return round(exact_us) if exact_us <= HORIZON_us else BEYOND_us


def s_from_us(instant: Instant) -> float:
    """Return an instant or a duration in seconds.

    >>> s_from_us(14_872_057)
    14.872057
    """
    return instant / MICROSECONDS_PER_SECOND


def service_time_us(remaining_MB: float, rate_MBps: float) -> Instant:
    """Return how long ``remaining_MB`` takes at ``rate_MBps``, rounded up to a microsecond.

    At most ``BEYOND_us``. Rounding up keeps unserved bytes from being discarded (paper,
    Section V-B).

    Args:
        remaining_MB: Bytes left to serve, 0 or more.
        rate_MBps: Service rate, greater than 0.

    >>> service_time_us(10.0, 3.0)
    3333334
    >>> service_time_us(1.0, 2.0)
    500000
    """
    exact_us = remaining_MB / rate_MBps * MICROSECONDS_PER_SECOND - COMPLETION_TOLERANCE_us
    if exact_us > HORIZON_us:
        return BEYOND_us
    return ceil(exact_us)  # of more than -1, so never negative
