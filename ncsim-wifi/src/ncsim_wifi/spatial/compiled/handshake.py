"""What RTS and CTS change, link by link.

Source: ``ncsim_wifi.spatial.handshake``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import BoolArray, FloatArray
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.compiled.state import State, Traffic, station_means
from ncsim_wifi.spatial.compiled.tables import Air
from ncsim_wifi.spatial.handshake import LARGEST_ON, BEFORE_CTS_us
from ncsim_wifi.spatial.overlap import LARGEST_ON as LARGEST_SILENCED


@inlined
def unaware_survival(air: Air, state: State, traffic: Traffic) -> FloatArray:
    """Return what frames of each link survive of unaware starts, others' and their own."""
    starts = _unaware_starts(air.spoilt, state, traffic)
    count, rate = len(starts), traffic.rate_per_us
    into = np.empty((len(air.links), len(air.senses)))
    for link in range(len(into)):
        for w in range(count):
            begun = starts[air.links[link].station, w] * air.meetings[link, w].exposed
            into[link, w] = begun * state.links[link].answered
    means = station_means(air.links, state, into)
    survives = np.empty(len(into))
    for link in range(len(into)):
        product, lost, w = 1.0, 0.0, air.links[link].station
        for u in range(count):
            product = product * (1.0 - into[link, u] * air.meetings[link, u].kill)
            part = means[u, w] * rate[u] / rate[w]
            lost = lost + part * air.meetings[link, u].own_kill
        survives[link] = product * (1.0 - min(1.0, lost))
    return survives


@inlined
def _unaware_starts(spoilt: BoolArray, state: State, traffic: Traffic) -> FloatArray:
    """Return how often w begins within an exchange of u that it senses, shape (u, w)."""
    count = len(traffic.tau)
    starts = np.empty((count, count))
    for u in range(count):
        for w in range(count):
            hears = 1.0
            for x in range(count):
                if spoilt[u, w, x]:
                    hears = hears * (1.0 - min(max(traffic.sending[u, x], 0.0), LARGEST_ON))
            waits = 1.0 - traffic.tau[w]
            starts[u, w] = (1.0 - hears) * state.clear[u, w] * (1.0 - waits * waits)
    return starts


@inlined
def learn_handshake(
    gain: float, air: Air, state: State, traffic: Traffic, by_stage: FloatArray
) -> None:
    """Update which RTS are answered, and who is silenced by CTS of hidden receivers.

    Args:
        gain: How far things move towards their new value.
        air: Links and stations.
        state: What is updated.
        traffic: What stations do.
        by_stage: Part of RTS that are answered, shape (links, 7).
    """
    count = len(traffic.tau)
    silenced_us = np.empty((len(air.links), len(air.senses)))
    for link in range(len(silenced_us)):
        fresh, own = 0.0, state.links[link]
        for k in range(STAGES):
            fresh = fresh + own.stages[k] * by_stage[link, k]
        own.answered = gain * fresh + (1.0 - gain) * own.answered
        after_us = air.links[link].on_air_us - BEFORE_CTS_us + air.links[link].overhead_us
        after_us = after_us * own.answered
        for w in range(count):
            silenced_us[link, w] = air.meetings[link, w].silenced * after_us
    heard_us = station_means(air.links, state, silenced_us)
    for u in range(count):
        free = 1.0
        for w in range(count):
            on = traffic.on[u, w] * (heard_us[w, u] / traffic.times.busy_us[w])
            free = free * (1.0 - min(max(on, 0.0), LARGEST_SILENCED))
        state.stations[u].silenced += gain * ((1.0 - free) - state.stations[u].silenced)
