"""The harm of weak interferers that act together with others, relation by relation.

Source: MODEL 3.7; see ``ncsim_wifi.spatial.overlap``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.attempts import Exchange
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.compiled.tables import Helpers
from ncsim_wifi.spatial.overlap import LARGEST_KILL, LARGEST_ON, LEAST_ON


@inlined
def helped_kill(
    helpers: Helpers, scale: float, on: FloatArray, times: Exchange, eager: FloatArray
) -> FloatArray:
    """Return kd of each of these relations, by stage of the sender.

    Args:
        helpers: The relations, and who helps.
        scale: Calibrated factor of the overlap.
        on: A[u, w].
        times: How long exchanges take.
        eager: How eager the interferer of each relation is by stage of the sender.
    """
    on_air_us, busy_us = times.on_air_us, times.busy_us
    count, most = helpers.helper.shape
    result, met = np.empty((count, STAGES)), np.empty(STAGES)
    killed, total = np.empty((1 << most, STAGES)), np.empty((1 << most, STAGES))
    for at in range(count):
        own, station = helpers.helped[at].own, helpers.helped[at].station
        part = min(max(on[own, station], LEAST_ON), LARGEST_ON)
        protected_us = helpers.helped[at].protected_us
        window_us = _overlap_us(on_air_us[station], busy_us[station] / part, protected_us, scale)
        used = 0  # those that are not there are the last
        while used < most and helpers.helper[at, used] >= 0:
            used += 1
        for held in range(1 << used):
            for k in range(STAGES):
                total[held, k] = helpers.omega[at, held]
                killed[held, k] = helpers.omega[at, held] * helpers.kill[at, held]
        for place in range(used - 1, -1, -1):
            helper, relation = helpers.helper[at, place], helpers.helper_relation[at, place]
            part = min(max(on[own, helper], LEAST_ON), LARGEST_ON)
            part = part * (on_air_us[helper] / busy_us[helper])
            for k in range(STAGES):
                now = part * eager[relation, k] if relation >= 0 else part
                met[k] = _met(min(now, LARGEST_ON), on_air_us[helper], window_us)
            _fold(killed, met, 1 << place)
            _fold(total, met, 1 << place)
        for k in range(STAGES):
            result[at, k] = min(killed[0, k] / max(total[0, k], 1e-300), LARGEST_KILL)
    return result


@inlined
def _fold(values: FloatArray, met: FloatArray, half: int) -> None:
    """Average sets of helpers without and with one of them, by stage."""
    for held in range(half):
        for k in range(STAGES):
            there = values[half + held, k] * met[k]
            values[held, k] = values[held, k] * (1.0 - met[k]) + there


@inlined
def _overlap_us(on_air_us: float, cycle_us: float, protected_us: float, scale: float) -> float:
    """Return L_o of one relation."""
    part = on_air_us / cycle_us
    met = min(1.0, (protected_us + on_air_us) / cycle_us)
    return scale * min(on_air_us, part * protected_us / met)


@inlined
def _met(part: float, on_air_us: float, window_us: float) -> float:
    """Return x_k of one helper of one relation."""
    off_us = on_air_us * (1.0 / part - 1.0)
    return 1.0 - (1.0 - part) * max(0.0, 1.0 - window_us / max(off_us, 1e-9))
