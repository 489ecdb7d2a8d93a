"""The harm of weak interferers that act together with others, relation by relation.

Source: MODEL 3.7; see ``ncsim_wifi.spatial.overlap``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.overlap import LARGEST_KILL, LARGEST_ON, LEAST_ON, Helped


@inlined
def helped_kill(
    helped: Helped, on: FloatArray, on_air_us: FloatArray, busy_us: FloatArray, eager: FloatArray
) -> FloatArray:
    """Return kd of each of these relations, by stage of the sender."""
    count, helpers, stages = eager.shape
    result = np.empty((count, stages))
    killed, total = np.empty(1 << helpers), np.empty(1 << helpers)
    for at in range(count):
        own, station = helped.own[at], helped.station[at]
        part = min(max(on[own, station], LEAST_ON), LARGEST_ON)
        window_us = _overlap_us(
            on_air_us[station], busy_us[station] / part, helped.protected_us[at], helped.scale
        )
        for stage in range(stages):
            for held in range(1 << helpers):
                total[held] = helped.omega[at, held]
                killed[held] = helped.omega[at, held] * helped.kill[at, held]
            for place in range(helpers - 1, -1, -1):
                helper, met = helped.helper[at, place], 0.0
                if helper >= 0:
                    part = min(max(on[own, helper], LEAST_ON), LARGEST_ON)
                    part = part * (on_air_us[helper] / busy_us[helper])
                    part = min(part * eager[at, place, stage], LARGEST_ON)
                    met = _met(part, on_air_us[helper], window_us)
                half = 1 << place
                for held in range(half):
                    killed[held] = killed[held] * (1.0 - met) + killed[half + held] * met
                    total[held] = total[held] * (1.0 - met) + total[half + held] * met
            result[at, stage] = min(killed[0] / max(total[0], 1e-300), LARGEST_KILL)
    return result


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
