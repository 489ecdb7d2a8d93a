"""Exponential and logarithm of one number; see ``ncsim_wifi.spatial.elementary``."""

import math

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.spatial.elementary import (
    BIAS,
    EXP_EVEN,
    EXP_ODD,
    LARGEST_EXP,
    LEAST_LOG,
    LN2_HIGH,
    LN2_LOW,
    LOG_ABOVE,
    LOG_BELOW,
    PER_LN2,
    POWERS_OF_2,
    SQRT_HALF,
)


@inlined
def exp(exponent: float) -> float:
    """Return e to a power of up to 700, as if that were at least -700."""
    rest = max(exponent, -LARGEST_EXP)
    whole = np.rint(rest * PER_LN2)
    rest = rest - whole * LN2_HIGH
    rest = rest - whole * LN2_LOW
    square = rest * rest
    even = (square * EXP_EVEN[0] + EXP_EVEN[1]) * square + EXP_EVEN[2]
    even = even * square + 1.0
    odd = ((square * EXP_ODD[0] + EXP_ODD[1]) * square + EXP_ODD[2]) * rest
    return float(((odd + odd) / (even - odd) + 1.0) * POWERS_OF_2[int(whole) + BIAS])


@inlined
def log(value: float) -> float:
    """Return the natural logarithm, as if the value were at least 2^-1000."""
    mantissa, exponent = math.frexp(max(value, LEAST_LOG))
    power = exponent - 0.5
    ratio = (mantissa - SQRT_HALF) / (mantissa + SQRT_HALF)
    z = ratio * ratio
    above = ((z * LOG_ABOVE[0] + LOG_ABOVE[1]) * z + LOG_ABOVE[2]) * z + LOG_ABOVE[3]
    below = ((z * LOG_BELOW[0] + LOG_BELOW[1]) * z + LOG_BELOW[2]) * z + LOG_BELOW[3]
    ratio = ratio + ratio
    beyond = above * z / below * ratio + power * LN2_LOW
    return (ratio + beyond) + power * LN2_HIGH
