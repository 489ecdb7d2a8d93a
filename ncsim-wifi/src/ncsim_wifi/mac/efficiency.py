"""What part of a PHY rate becomes payload."""

from functools import lru_cache
from typing import NamedTuple

from ncsim_core.units import MEGABITS_PER_MEGABYTE

from ncsim_wifi.mac.bianchi import FixedPoint, fixed_point
from ncsim_wifi.mac.timing import Timing, data_frame_us


class SlotShares(NamedTuple):
    """How often a slot is idle, carries one frame, or a collision; they add up to 1."""

    idle: float
    success: float
    collision: float


def slot_shares(tau: float, stations: int) -> SlotShares:
    """Return P_I, P_S and P_C.

    Source: below Eq. 8 (``eq:eta``).
    """
    idle = (1.0 - tau) ** stations
    success = stations * tau * (1.0 - tau) ** (stations - 1)
    return SlotShares(idle, success, max(0.0, 1.0 - idle - success))


def mean_slot_us(shares: SlotShares, rate_Mbps: float, timing: Timing) -> float:
    """Return the mean duration of a slot of the model, the denominator of Eq. 8."""
    return (
        shares.idle * timing.slot_us
        + shares.success * timing.success_us(rate_Mbps)
        + shares.collision * timing.collision_us(rate_Mbps)
    )


def efficiency_at(point: FixedPoint, stations: int, rate_Mbps: float, timing: Timing) -> float:
    """Return the payload efficiency eta of ``stations`` at a given equilibrium.

    Source: Eq. 8 (``eq:eta``).
    """
    shares = slot_shares(point.tau, stations)
    payload_us = timing.payload_bits / rate_Mbps
    return shares.success * payload_us / mean_slot_us(shares, rate_Mbps, timing)


@lru_cache(maxsize=65536)
def efficiency(stations: int, rate_Mbps: float, timing: Timing) -> float:
    """Return eta(n, R): the part of the PHY rate that all n stations deliver together.

    Source: Eq. 8 (``eq:eta``) with W_min = 16 and m = 6.

    Args:
        stations: Number n of contending stations, 1 or more.
        rate_Mbps: PHY rate R, greater than 0.
        timing: Frame timing.
    """
    return efficiency_at(fixed_point(stations), stations, rate_Mbps, timing)


@lru_cache(maxsize=65536)
def channel_goodput_Mbps(stations: int, rate_Mbps: float, timing: Timing) -> float:
    """Return R eta(n, R), what all n stations deliver together; 0 at rate 0.

    R cancels: it is P_S L / E[slot]. Computed so, two rates that need equally many symbols
    give the same number to the last bit, and a higher rate never delivers less.

    Source: Eq. 8 (``eq:eta``) times R.
    """
    if rate_Mbps <= 0.0:
        return 0.0
    shares = slot_shares(fixed_point(stations).tau, stations)
    return shares.success * timing.payload_bits / mean_slot_us(shares, rate_Mbps, timing)


def station_goodput_MBps(stations: int, rate_Mbps: float, timing: Timing) -> float:
    """Return what each of n contending stations delivers, R eta(n, R) / (8 n); 0 at rate 0.

    Source: below Eq. 8 (``eq:eta``); with n = 1 the clean solo bandwidth B above Eq. 12.
    """
    return channel_goodput_Mbps(stations, rate_Mbps, timing) / (MEGABITS_PER_MEGABYTE * stations)


def data_airtime_fraction(rate_Mbps: float, timing: Timing) -> float:
    """Return the part of time in which a lone saturated station sends data frames.

    Source: Section VI-C (``sec:ns3_validation``), a; SPEC 6, a = tau T_D / E[slot] at n = 1.
    """
    tau = fixed_point(1).tau
    return tau * data_frame_us(rate_Mbps) / mean_slot_us(slot_shares(tau, 1), rate_Mbps, timing)
