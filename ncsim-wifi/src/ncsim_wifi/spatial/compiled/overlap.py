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
    result = np.empty((count, STAGES))
    killed, total = np.empty(1 << most), np.empty(1 << most)
    for at in range(count):
        own, station = helpers.helped[at].own, helpers.helped[at].station
        part = min(max(on[own, station], LEAST_ON), LARGEST_ON)
        protected_us = helpers.helped[at].protected_us
        window_us = _overlap_us(on_air_us[station], busy_us[station] / part, protected_us, scale)
        for stage in range(STAGES):
            for held in range(1 << most):
                total[held] = helpers.omega[at, held]
                killed[held] = helpers.omega[at, held] * helpers.kill[at, held]
            for place in range(most - 1, -1, -1):
                helper, half = helpers.helper[at, place], 1 << place
                if helper < 0:
                    continue  # nobody is never there
                part = min(max(on[own, helper], LEAST_ON), LARGEST_ON)
                part = part * (on_air_us[helper] / busy_us[helper])
                relation = helpers.helper_relation[at, place]
                if relation >= 0:
                    part = part * eager[relation, stage]
                met = _met(min(part, LARGEST_ON), on_air_us[helper], window_us)
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
