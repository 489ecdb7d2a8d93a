"""What stations beyond the nearest leave of frames, link by link.

Source: MODEL 2; see ``ncsim_wifi.spatial.near`` and ``ncsim_wifi.spatial.hazard``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.compiled.elementary import exp, log
from ncsim_wifi.spatial.compiled.tables import Air, Constants
from ncsim_wifi.spatial.elementary import PER_e_dB
from ncsim_wifi.spatial.hazard import GRID_FROM_dB, GRID_STEPS_PER_dB, GRID_TO_dB
from ncsim_wifi.spatial.near import LARGEST_ON


@inlined
def far_noise_survival(constants: Constants, air: Air, sending: FloatArray) -> FloatArray:
    """Return what the noise of far interferers leaves of the frames of each link."""
    survives = np.ones(len(air.links))
    if not constants.has_far:
        return survives
    for link in range(len(survives)):
        far_mW, own = 0.0, air.links[link]
        for w in range(len(sending)):
            far_mW = far_mW + air.meetings[link, w].far_mW * sending[own.station, w]
        ratio_dB = own.signal_dBm - PER_e_dB * log(constants.noise_mW + far_mW)
        whole = exp(_ln_hazard(air.grid, own.hazard_row, ratio_dB))
        survives[link] = exp(-max(0.0, whole - own.noise_hazard))
    return survives


@inlined
def _ln_hazard(grid: FloatArray, row: int, ratio_dB: float) -> float:
    """Return ln h at a ratio, of a scheme whose values begin at a place of the grid."""
    within_dB = min(max(ratio_dB, GRID_FROM_dB), GRID_TO_dB)
    at = (within_dB - GRID_FROM_dB) * GRID_STEPS_PER_dB
    below = int(at)
    place = row + below
    return float(grid[place] + (at - below) * (grid[place + 1] - grid[place]))


@inlined
def others_survival(air: Air, sending: FloatArray, on_air_us: FloatArray) -> FloatArray:
    """Return what harmful interferers beyond the nearest leave of the frames of each link."""
    survives = np.ones(len(air.links))
    on, begun = np.zeros((2, len(air.link_of_group)))
    for other in air.others:
        own, w, group = air.links[other.link], other.station, other.group
        part = other.harm * sending[own.station, w]
        on[group] += part
        begun[group] += part * (own.protected_us / on_air_us[w])
    for group in range(len(on)):
        free = 1.0 - min(on[group], LARGEST_ON)
        survives[air.link_of_group[group]] *= free * exp(-(begun[group] / free))
    return survives
