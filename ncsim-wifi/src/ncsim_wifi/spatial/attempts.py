"""How often stations try to send while the channel is clear.

Source: MODEL 3.2.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.mac.timing import AIFS_us, RTS_us, SLOT_us
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.sums import row_products, row_sums

ACK_TIMEOUT_us = 45.0
LEAST_OWN_WAIT = 0.35
IN_VAIN_us = RTS_us + ACK_TIMEOUT_us + AIFS_us
GAUSS_AT = 0.5 + 0.5 * np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)])
GAUSS_WEIGHT = np.array([5.0, 8.0, 5.0]) / 18.0


class Exchange(NamedTuple):
    """How long the parts of an exchange take, by station.

    Args:
        on_air_us: T_u, from the start to the end of data.
        overhead_us: ovh_u, from there until the sender may count again.
        silent_us: b_u, from there until its neighbours may.
        deviation_us: dev[u, w], how much longer w in particular stays silent.
        busy_us: For how long a frame of each station keeps others from counting.
    """

    on_air_us: FloatArray
    overhead_us: FloatArray
    silent_us: FloatArray
    deviation_us: FloatArray
    busy_us: FloatArray


class Attempts(NamedTuple):
    """Attempts of each station.

    Args:
        same_slot: p[u, w], probability that w starts in the same slot as u.
        rate_per_us: lambda, attempts per time in which the channel is clear.
        activity: rho, mean time on air and after per clear time.
    """

    same_slot: FloatArray
    rate_per_us: FloatArray
    activity: FloatArray


def first_in_line(same_slot: FloatArray) -> FloatArray:
    """Return E[1 / (1 + colliders)] of each station.

    Source: MODEL 3.2, share: the integral of prod (1 - p (1 - y)) by three Gauss points.
    """
    shares = np.zeros(len(same_slot))
    for at, weight in zip(GAUSS_AT.tolist(), GAUSS_WEIGHT.tolist(), strict=True):
        shares = shares + row_products(1.0 - same_slot * (1.0 - at)) * weight
    return shares


def clear_slot_rate_per_us(
    tau: FloatArray, idle_slot: FloatArray, extra_us: FloatArray
) -> FloatArray:
    """Return lambda_0, the attempts per clear time, of stations that are always allowed to.

    Source: MODEL 3.2.

    Args:
        tau: Probability of an attempt per decision.
        idle_slot: P0, probability that nobody starts in a slot.
        extra_us: x, mean extra silence per slot after frames of others.
    """
    idle_us = SLOT_us * idle_slot
    return tau / np.maximum(idle_us + extra_us, idle_us / 2.0)


class Contenders(NamedTuple):
    """Who may send, before an attempt.

    Args:
        senses: 1 where stations sense each other.
        tau: Probability of an attempt per decision of each station.
        clear: C of the occupancy.
        able: (1 - B) alpha, how often each station has a frame and is not kept silent otherwise.
        asks_first: Whether RTS and CTS precede data.
    """

    senses: FloatArray
    tau: FloatArray
    clear: FloatArray
    able: FloatArray
    asks_first: bool


def attempts_of(contenders: Contenders, times: Exchange) -> Attempts:
    """Return the attempts of all stations.

    Args:
        contenders: Who may send.
        times: How long exchanges take.
    """
    senses, tau, clear, able, asks_first = contenders
    same_slot = np.minimum(np.maximum(senses * (tau * able) * clear, 0.0), 1.0)
    nobody = row_products(1.0 - same_slot)
    extra_us = row_sums(same_slot * times.deviation_us.T) * (1.0 - tau)
    rate_0 = clear_slot_rate_per_us(tau, nobody * (1.0 - tau), extra_us) * able
    own_wait_us = 1.0 / rate_0 + times.overhead_us - times.silent_us
    rate = 1.0 / np.maximum(own_wait_us, LEAST_OWN_WAIT / rate_0)
    share = first_in_line(same_slot)
    if not asks_first:
        return Attempts(same_slot, rate, rate * times.busy_us * share)
    first = np.maximum(share - nobody, (1.0 - nobody) / 2.0)
    return Attempts(same_slot, rate, rate * (nobody * times.busy_us + first * IN_VAIN_us))
