"""How often stations try to send while the channel is clear, station by station.

Source: MODEL 3.2; see ``ncsim_wifi.spatial.attempts``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.mac.timing import SLOT_us
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.attempts import (
    GAUSS_AT,
    GAUSS_WEIGHT,
    LEAST_OWN_WAIT,
    Attempts,
    Contenders,
    Exchange,
    IN_VAIN_us,
)


@inlined
def attempts_of(contenders: Contenders, times: Exchange) -> Attempts:
    """Return the attempts of all stations."""
    count = len(contenders.tau)
    same_slot = np.empty((count, count))
    rate, activity = np.empty(count), np.empty(count)
    for u in range(count):
        for w in range(count):
            meets = contenders.senses[u, w] * (contenders.tau[w] * contenders.able[w])
            same_slot[u, w] = min(max(meets * contenders.clear[u, w], 0.0), 1.0)
        nobody = _nobody(same_slot[u], 1.0)
        rate[u] = _rate_per_us(contenders, times, u, same_slot[u], nobody)
        share = _first_in_line(same_slot[u])
        if contenders.asks_first:
            first = max(share - nobody, (1.0 - nobody) / 2.0)
            activity[u] = rate[u] * (nobody * times.busy_us[u] + first * IN_VAIN_us)
        else:
            activity[u] = rate[u] * times.busy_us[u] * share
    return Attempts(same_slot, rate, activity)


@inlined
def _nobody(same_slot: FloatArray, part: float) -> float:
    """Return how likely nobody starts in the same slot, of whom a part counts."""
    result = 1.0
    for w in range(len(same_slot)):
        result = result * (1.0 - same_slot[w] * part)
    return result


@inlined
def _first_in_line(same_slot: FloatArray) -> float:
    """Return E[1 / (1 + colliders)] of one station."""
    share = 0.0
    for place in range(len(GAUSS_AT)):
        share = share + _nobody(same_slot, 1.0 - GAUSS_AT[place]) * GAUSS_WEIGHT[place]
    return share


@inlined
def _rate_per_us(
    contenders: Contenders, times: Exchange, u: int, same_slot: FloatArray, nobody: float
) -> float:
    """Return lambda of one station."""
    tau, able = contenders.tau[u], contenders.able[u]
    extra_us = 0.0
    for w in range(len(same_slot)):
        extra_us = extra_us + same_slot[w] * times.deviation_us[w, u]
    extra_us = extra_us * (1.0 - tau)
    idle_us = SLOT_us * (nobody * (1.0 - tau))
    rate_0 = tau / max(idle_us + extra_us, idle_us / 2.0) * able
    own_wait_us = 1.0 / rate_0 + times.overhead_us[u] - times.silent_us[u]
    return float(1.0 / max(own_wait_us, LEAST_OWN_WAIT / rate_0))
