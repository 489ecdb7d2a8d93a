"""Bianchi's fixed point: how often a saturated station transmits, and how often in vain."""

from functools import cache
from typing import NamedTuple

from ncsim_core.errors import ConvergenceError

MIN_CONTENTION_WINDOW = 16  # backoff choices, CW_min + 1 (Section IV-F, sec:bianchi)
MAX_BACKOFF_STAGE = 6
MAX_RESIDUAL = 1e-13  # Section VI-B (sec:external_val)
MAX_STEPS = 100


class FixedPoint(NamedTuple):
    """The equilibrium of n saturated stations.

    Args:
        tau: Probability that a station transmits in a slot.
        p: Probability that a transmission collides.
    """

    tau: float
    p: float


def transmission_probability(p: float, window: int, max_stage: int) -> float:
    """Return tau when a transmission collides with probability ``p``.

    The finite sum avoids the apparent singularity of the closed form at p = 1/2.

    Source: Eq. 6 (``eq:tau``).

    Args:
        p: Collision probability, in [0, 1].
        window: Backoff choices W_min at stage 0.
        max_stage: Maximum backoff stage m.

    >>> transmission_probability(0.0, 16, 6) == 2 / 17
    True
    """
    doubling_sum, term = 0.0, 1.0
    for _ in range(max_stage):
        doubling_sum += term
        term *= 2.0 * p
    return 2.0 / (window + 1.0 + window * p * doubling_sum)


def collision_probability(tau: float, stations: int) -> float:
    """Return p when each of ``stations`` transmits with probability ``tau``.

    Source: Eq. 7 (``eq:p``).

    >>> collision_probability(0.1, 1)
    0.0
    """
    return 1.0 - (1.0 - tau) ** (stations - 1)


@cache
def fixed_point(
    stations: int, window: int = MIN_CONTENTION_WINDOW, max_stage: int = MAX_BACKOFF_STAGE
) -> FixedPoint:
    """Return the joint solution of Eqs. 6 and 7 by bisection on p in [0, 1].

    p exceeds ``collision_probability(tau(p))`` exactly above the solution, because tau falls
    with p. Halving goes on until the interval holds no number between its ends.

    Source: Eqs. 6 and 7 (``eq:tau``, ``eq:p``); SPEC 7.

    Args:
        stations: Number n of contending stations, 1 or more.
        window: Backoff choices W_min at stage 0.
        max_stage: Maximum backoff stage m.

    Raises:
        ConvergenceError: The residual of Eq. 7 exceeds 1e-13 after 100 steps.
    """
    low, high = 0.0, 1.0
    for _ in range(MAX_STEPS):
        p = (low + high) / 2.0
        if p in (low, high):
            break
        if residual(p, stations, window, max_stage) < 0.0:
            low = p
        else:
            high = p
    p = min(low, high, key=lambda at: abs(residual(at, stations, window, max_stage)))
    error = abs(residual(p, stations, window, max_stage))
    if error > MAX_RESIDUAL:
        raise ConvergenceError(
            f"Bianchi's fixed point for n={stations}, W={window}, m={max_stage}: residual "
            f"{error:.3g} exceeds {MAX_RESIDUAL:g} after {MAX_STEPS} bisection steps"
        )
    return FixedPoint(transmission_probability(p, window, max_stage), p)


def residual(p: float, stations: int, window: int, max_stage: int) -> float:
    """Return by how much ``p`` exceeds the collision probability that it leads to."""
    return p - collision_probability(transmission_probability(p, window, max_stage), stations)
