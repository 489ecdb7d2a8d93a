"""Quantiles of Student's t distribution, without a statistics library."""

import math
from functools import lru_cache
from typing import Final

_TINY: Final = 1e-300
_FRACTION_TOLERANCE: Final = 1e-16
_MAX_FRACTION_TERMS: Final = 100_000
_BISECTION_STEPS: Final = 200


@lru_cache(maxsize=1024)
def t_quantile(probability: float, degrees: int) -> float:
    """Return the value that a t variable stays below with a probability.

    Source: the distribution function 1 - I(n / (n + t^2); n/2, 1/2) / 2 for t > 0, Abramowitz and
    Stegun 26.7.1, inverted by bisection.

    Args:
        probability: Strictly between 0 and 1.
        degrees: Degrees of freedom n, at least 1.

    Raises:
        ValueError: An argument is out of range.

    >>> round(t_quantile(0.975, 4), 6)
    2.776445
    """
    if not 0 < probability < 1 or degrees < 1:
        raise ValueError(f"no t quantile for probability {probability} and {degrees} degrees")
    if probability < 1 / 2:
        return -t_quantile(1 - probability, degrees)
    low, high = 0.0, 1.0
    while _upper_tail(high, degrees) > 1 - probability:
        low, high = high, 2 * high
    for _ in range(_BISECTION_STEPS):
        middle = (low + high) / 2
        if middle in (low, high):
            break
        if _upper_tail(middle, degrees) > 1 - probability:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def _upper_tail(t: float, degrees: int) -> float:
    """Return the probability that a t variable exceeds ``t``, 0 or more."""
    if t * t < degrees:  # near the middle, the complement is the exact one to compute
        return (1 - incomplete_beta(t * t / (degrees + t * t), 1 / 2, degrees / 2)) / 2
    return incomplete_beta(degrees / (degrees + t * t), degrees / 2, 1 / 2) / 2


def incomplete_beta(x: float, a: float, b: float) -> float:
    """Return the regularised incomplete beta function I(x; a, b).

    Source: Abramowitz and Stegun 26.5.8 (continued fraction) and 26.5.2 (symmetry).

    >>> incomplete_beta(0.5, 2.0, 2.0)
    0.5
    """
    if x <= 0:
        return 0.0
    if x >= 1:
        return 1.0
    if x > (a + 1) / (a + b + 2):
        return 1 - incomplete_beta(1 - x, b, a)
    log_front = (
        math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x)
    )
    return math.exp(log_front) * _continued_fraction(x, a, b) / a


def _continued_fraction(x: float, a: float, b: float) -> float:
    """Return the continued fraction of the incomplete beta function by Lentz's method."""
    c = 1.0
    d = 1 / _not_zero(1 - (a + b) * x / (a + 1))
    value = d
    for m in range(1, _MAX_FRACTION_TERMS):
        even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
        odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
        step = 1.0
        for term in (even, odd):
            d = 1 / _not_zero(1 + term * d)
            c = _not_zero(1 + term / c)
            step = c * d
            value *= step
        if abs(step - 1) <= _FRACTION_TOLERANCE:
            break
    return value


def _not_zero(value: float) -> float:
    return value if abs(value) > _TINY else _TINY
