"""How long stations stay silent after an exchange they heard, station by station.

Source: MODEL 3.4; see ``ncsim_wifi.spatial.silence``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.mac.timing import AIFS_us
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.compiled.state import State, station_means
from ncsim_wifi.spatial.compiled.tables import Air, Constants
from ncsim_wifi.spatial.handshake import NAV_TIMEOUT_us
from ncsim_wifi.spatial.silence import EIFS_WEIGHT


@inlined
def learn_silence(constants: Constants, air: Air, overhead_us: FloatArray, state: State) -> None:
    """Bring b_u and dev[u, w] up to date."""
    count, gain = len(overhead_us), constants.gain
    if not constants.silence:
        for u in range(count):
            silent_us = (1.0 - gain) * state.stations[u].silent_us
            state.stations[u].silent_us = gain * overhead_us[u] + silent_us
        return
    by_station_us = station_means(air.links, state, _by_link_us(constants, air, state))
    for u in range(count):
        sum_us = degree = 0.0
        for w in range(count):
            sum_us = sum_us + by_station_us[u, w] * air.senses[u, w]
            degree = degree + air.senses[u, w]
        mean_us = sum_us / degree if degree > 0.0 else overhead_us[u]
        silent_us = (1.0 - gain) * state.stations[u].silent_us
        state.stations[u].silent_us = gain * mean_us + silent_us
        for w in range(count):
            longer_us = EIFS_WEIGHT * (by_station_us[u, w] - mean_us) * air.senses[u, w]
            state.deviation_us[u, w] = gain * longer_us + (1.0 - gain) * state.deviation_us[u, w]


@inlined
def _by_link_us(constants: Constants, air: Air, state: State) -> FloatArray:
    """Return bl[l, w], how long w stays silent after exchanges of link l."""
    by_link_us = np.empty((len(air.links), len(air.senses)))
    for link in range(len(by_link_us)):
        u, part = air.links[link].station, state.links[link].answered
        for w in range(by_link_us.shape[1]):
            heard = air.meetings[link, w]
            missed = min(max(1.0 - state.clear[u, w], 0.0), 1.0)
            waits_us = missed * AIFS_us + (1.0 - missed) * heard.noticed_us
            silent_us = heard.answered_us + heard.unheard * waits_us
            if constants.rts_cts:
                silent_us = part * silent_us + (1.0 - part) * (NAV_TIMEOUT_us + AIFS_us)
            by_link_us[link, w] = silent_us
    return by_link_us
