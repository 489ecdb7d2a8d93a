"""How often each back-off stage is visited, link by link.

Source: MODEL 3.11; see ``ncsim_wifi.spatial.backoff``.
"""

from typing import Any

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.compiled.state import State
from ncsim_wifi.spatial.compiled.tables import Records


@inlined
def visit(gain: float, links: Records, state: State, success: FloatArray) -> None:
    """Update stages, attempt shares and losses."""
    per_packet, total = np.empty(len(links)), np.zeros(len(state.stations))
    for link in range(len(links)):
        own = state.links[link]
        _learn_stages(gain, success[link], own)
        per_packet[link] = own.packets / own.stages[0]
        total[links[link].station] += per_packet[link]
        delivered = own.stages[0] * success[link, 0]
        for k in range(1, STAGES):
            delivered = delivered + own.stages[k] * success[link, k]
        own.loss = 1.0 - delivered
    for u in range(len(total)):
        for k in range(STAGES):
            state.stations[u].stages[k] = 0.0
    for link in range(len(links)):
        own, station = state.links[link], state.stations[links[link].station]
        own.attempts = per_packet[link] / total[links[link].station]
        for k in range(STAGES):
            station.stages[k] += own.attempts * own.stages[k]


@inlined
def _learn_stages(gain: float, success: FloatArray, own: Any) -> None:  # noqa: ANN401 - a record
    """Bring the stages of one link up to date."""
    visits, total = np.empty(STAGES), 1.0
    visits[0] = 1.0
    for k in range(1, STAGES):
        visits[k] = visits[k - 1] * (1.0 - min(max(success[k - 1], 0.0), 1.0))
        total = total + visits[k]
    for k in range(STAGES):
        own.stages[k] = gain * (visits[k] / total) + (1.0 - gain) * own.stages[k]
