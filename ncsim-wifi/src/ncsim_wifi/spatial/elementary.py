"""Exponential and logarithm in plain arithmetic: the same bits everywhere.

Those of numpy and of the C library differ in the last bit from each other, and from one processor
to the next. These are the same for arrays as in compiled loops (``compiled/elementary.py``), right
to two units in the last place, and the logarithm near 1 to 2e-16. Their arguments are reduced as
Cody and Waite (1980, Software Manual for the Elementary Functions) do; the fractions are Padé
approximants.
"""

from typing import Final

import numpy as np

from ncsim_wifi.quantities import FloatArray

PER_LN2: Final = 1.4426950408889634  # 1 / ln 2
LN2_HIGH: Final = 0.693147180369123816490  # 33 bits, so that whole multiples are exact
LN2_LOW: Final = 1.90821492927058770002e-10
LARGEST_EXP: Final = 700.0
LEAST_LOG: Final = 2.0**-1000
SQRT_HALF: Final = 0.7071067811865476
PER_e_dB: Final = 4.342944819032518  # 10 / ln 10
BIAS: Final = 1022
POWERS_OF_2: Final = np.ldexp(1.0, np.arange(-BIAS, BIAS))

EXP_EVEN: Final = (1.0 / 665280.0, 1.0 / 792.0, 5.0 / 44.0)
EXP_ODD: Final = (1.0 / 15840.0, 1.0 / 66.0, 1.0 / 2.0)
LOG_ABOVE: Final = (-256.0 / 225225.0, 241.0 / 2275.0, -2.0 / 5.0, 1.0 / 3.0)
LOG_BELOW: Final = (-21.0 / 143.0, 63.0 / 65.0, -9.0 / 5.0, 1.0)


def exp(exponent: FloatArray) -> FloatArray:
    """Return e to a power of up to 700, as if that were at least -700.

    With r the exponent less k ln 2, e^r = 1 + 2 q / (p - q), p even in r and q odd.

    >>> exp(np.array([0.0, 1.0])).round(14).tolist()
    [1.0, 2.71828182845905]
    """
    rest = np.maximum(exponent, -LARGEST_EXP)
    whole = np.rint(rest * PER_LN2)
    rest -= whole * LN2_HIGH
    rest -= whole * LN2_LOW
    square = rest * rest
    even = _polynomial(square, EXP_EVEN)
    even *= square
    even += 1.0
    odd = _polynomial(square, EXP_ODD)
    odd *= rest
    even -= odd
    odd += odd
    odd /= even
    odd += 1.0
    return np.asarray(np.ldexp(odd, whole.astype(np.int32)))


def log(value: FloatArray) -> FloatArray:
    """Return the natural logarithm, as if the value were at least 2^-1000.

    With m from 1/2 to 1, c = sqrt(1/2) and s = (m - c) / (m + c), ln (m / c) = 2 artanh s.

    >>> log(np.array([2.0, 8.0])).round(14).tolist()
    [0.69314718055995, 2.07944154167984]
    """
    mantissa, exponent = np.frexp(np.maximum(value, LEAST_LOG))
    power = exponent - 0.5
    ratio = (mantissa - SQRT_HALF) / (mantissa + SQRT_HALF)
    square = ratio * ratio
    beyond = _polynomial(square, LOG_ABOVE)
    beyond *= square
    beyond /= _polynomial(square, LOG_BELOW)
    ratio += ratio
    beyond *= ratio
    beyond += power * LN2_LOW
    ratio += beyond
    ratio += power * LN2_HIGH
    return ratio


def _polynomial(at: FloatArray, coefficients: tuple[float, ...]) -> FloatArray:
    """Return a polynomial, highest power first."""
    result = at * coefficients[0]
    for coefficient in coefficients[1:-1]:
        result += coefficient
        result *= at
    result += coefficients[-1]
    return result
