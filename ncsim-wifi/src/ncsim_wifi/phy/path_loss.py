"""How much a signal loses on its way."""

import math

import numpy as np

from ncsim_wifi.quantities import FloatArray, Quantity, log10

SPEED_OF_LIGHT_m_per_s = 3e8  # SPEC 1; the exact value gives 24.26 dB instead of 24.27 at 30 m
REFERENCE_DISTANCE_m = 1.0  # d_0 of Eq. 2


def reference_loss_dB(freq_ghz: float) -> float:
    """Return the free-space loss PL(d_0) at 1 m.

    Source: Friis, named below Eq. 3 (``eq:rxpower``).

    >>> round(reference_loss_dB(5.0), 2)
    46.42
    """
    wavelength_m = SPEED_OF_LIGHT_m_per_s / (freq_ghz * 1e9)
    return 20.0 * math.log10(4.0 * math.pi * REFERENCE_DISTANCE_m / wavelength_m)


def path_loss_dB(distance_m: Quantity, reference_loss_dB: float, exponent: float) -> Quantity:
    """Return the loss over a distance; less than 1 m counts as 1 m.

    Source: Eq. 2 (``eq:pathloss``).

    Args:
        distance_m: Separation of transmitter and receiver, any shape.
        reference_loss_dB: Loss at 1 m.
        exponent: Path-loss exponent n; 2 is free space.

    >>> round(path_loss_dB(30.0, 46.42, 3.0), 2)
    90.73
    """
    clipped_m: Quantity = np.maximum(distance_m, REFERENCE_DISTANCE_m)
    return reference_loss_dB + 10.0 * exponent * log10(clipped_m)


def distances_m(positions_m: FloatArray) -> FloatArray:
    """Return the distance between any two of ``positions_m``, from shape (n, 2) to (n, n).

    Infinite if it has no number.
    """
    x_m, y_m = positions_m[:, 0], positions_m[:, 1]
    with np.errstate(over="ignore"):
        return np.hypot(x_m[:, None] - x_m[None, :], y_m[:, None] - y_m[None, :])
