"""Arrays of physical quantities, and the one conversion between decibels and milliwatts."""

import math
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]
BoolArray: TypeAlias = NDArray[np.bool_]

Quantity = TypeVar("Quantity", float, FloatArray)
"""One number or an array of them; a formula returns the shape it was given."""


def log10(value: Quantity) -> Quantity:
    """Return the decimal logarithm; minus infinity for 0."""
    if isinstance(value, float):
        return math.log10(value) if value > 0.0 else -math.inf
    with np.errstate(divide="ignore"):
        result: Quantity = np.log10(value)
    return result


def mW_from_dBm(power_dBm: Quantity) -> Quantity:
    """Return a power in milliwatts.

    >>> mW_from_dBm(20.0)
    100.0
    """
    power_mW: Quantity = 10.0 ** (power_dBm / 10.0)
    return power_mW


def dBm_from_mW(power_mW: Quantity) -> Quantity:
    """Return a power in dBm; minus infinity for 0."""
    return 10.0 * log10(power_mW)
