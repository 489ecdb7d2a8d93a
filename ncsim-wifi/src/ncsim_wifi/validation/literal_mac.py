"""Medium access as the paper writes it, number by number, for the fluid to compare with.

Nothing here is shared with ``ncsim_wifi.mac``: tau comes from the decimal solver, and the
formulas of Section IV-F and Appendix A stand as they are printed.
"""

import math
from functools import cache
from typing import NamedTuple

from ncsim_wifi.validation.decimal_solver import decimal_tau


class Slot(NamedTuple):
    """What a slot of Bianchi's model is on average.

    Args:
        tau: Probability that a station transmits in it.
        success: Probability that it carries one frame.
        mean_us: Its duration.
    """

    tau: float
    success: float
    mean_us: float


def frame_us(rate_Mbps: float) -> float:
    """Return T_D, the duration of a data frame: Eq. 15."""
    return 44.0 + 13.6 * math.ceil((16 + 8 * 1542 + 6) / (13.6 * rate_Mbps))


@cache
def slot(n: int, rate_Mbps: float, *, rts_cts: bool = False) -> Slot:
    """Return the mean slot of ``n`` stations: the denominator of Eq. 8, with Eqs. 16 to 19."""
    tau = float(decimal_tau(n))
    idle = (1.0 - tau) ** n
    success = n * tau * (1.0 - tau) ** (n - 1)
    success_us = frame_us(rate_Mbps) + 16.0 + 28.0 + 43.0 + 2 * 0.1
    collision_us = frame_us(rate_Mbps) + 16.0 + 28.0 + 43.0 + 0.1
    if rts_cts:
        success_us += 28.0 + 28.0 + 2 * 16.0 + 2 * 0.1
        collision_us = 28.0 + 16.0 + 28.0 + 43.0 + 0.1
    mean_us = idle * 9.0 + success * success_us + (1.0 - idle - success) * collision_us
    return Slot(tau, success, mean_us)


def goodput_Mbps(n: int, rate_Mbps: float, *, rts_cts: bool = False) -> float:
    """Return what ``n`` stations deliver together, R eta(n, R): Eq. 8."""
    each = slot(n, rate_Mbps, rts_cts=rts_cts)
    return rate_Mbps * (each.success * (8 * 1472 / rate_Mbps) / each.mean_us)


def airtime_fraction(rate_Mbps: float) -> float:
    """Return a, the part of time in which a lone saturated station sends data (Section VI-C)."""
    alone = slot(1, rate_Mbps)
    return alone.tau * frame_us(rate_Mbps) / alone.mean_us
