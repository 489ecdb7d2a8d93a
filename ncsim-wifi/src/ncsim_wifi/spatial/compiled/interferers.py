"""The interferers of each relation as its link meets them.

Source: MODEL 3.8; see ``ncsim_wifi.spatial.losses``.
"""

from typing import NamedTuple

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.mac.timing import ACK_us, RTS_us, SIFS_us
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.compiled.state import State, Traffic
from ncsim_wifi.spatial.compiled.tables import Air, Constants, Hidden, Records
from ncsim_wifi.spatial.gaps import Interferers
from ncsim_wifi.spatial.handshake import BEFORE_CTS_us, NAV_TIMEOUT_us
from ncsim_wifi.spatial.overlap import LARGEST_ON


class Groups(NamedTuple):
    """What the interferers of a group do together; by group.

    Args:
        rate_per_us: How often one of them begins.
        on: Sum of A'.
        busy_us: Mean time that one of their frames keeps others from counting.
        spare_us: Mean time that they wait longer than others after their frames.
        waits: How likely none of them starts in a slot.
    """

    rate_per_us: FloatArray
    on: FloatArray
    busy_us: FloatArray
    spare_us: FloatArray
    waits: FloatArray


@inlined
def groups_of(hidden: Hidden, traffic: Traffic, later: FloatArray) -> tuple[Groups, FloatArray]:
    """Return the groups, and phi_j of each relation, from A' of each."""
    relations, times = hidden.relations, traffic.times
    rate, on, busy_us, spare_us = np.zeros((4, len(hidden.link_of_group)))
    waits, phi = np.ones(len(rate)), np.empty(len(relations))
    for at in range(len(phi)):
        rate[relations[at].group] += traffic.rate_per_us[relations[at].station]
    for at in range(len(phi)):
        group, w = relations[at].group, relations[at].station
        phi[at] = traffic.rate_per_us[w] / rate[group]
        on[group] += later[at]
        busy_us[group] += phi[at] * times.busy_us[w]
        spare_us[group] += phi[at] * (times.overhead_us[w] - times.silent_us[w])
        waits[group] *= 1.0 - traffic.tau[w]
    return Groups(rate, on, busy_us, spare_us, waits), phi


@inlined
def interferers_of(
    senses: FloatArray,
    relations: Records,
    state: State,
    traffic: Traffic,
    groups: Groups,
    seen_us: FloatArray,
) -> Interferers:
    """Return the interferers of each relation as its link meets them.

    Args:
        senses: 1 where stations sense each other.
        relations: The relations.
        state: Stages.
        traffic: What stations do.
        groups: What groups of interferers do.
        seen_us: T, ovh and ov as the sender meets them, shape (3, relations).
    """
    count = len(relations)
    share, stages = np.empty((count, STAGES)), np.empty((count, STAGES))
    others, sum_on, busy_us, spare_us = np.ones((4, count))
    for at in range(count):
        group, w = relations[at].group, relations[at].station
        if relations[at].has_company:
            others[at] = groups.waits[group] / (1.0 - traffic.tau[w])
        sum_on[at] = min(LARGEST_ON, groups.on[group])
        busy_us[at], spare_us[at] = groups.busy_us[group], groups.spare_us[group]
        for k in range(STAGES):
            own_rate = 1.0 / traffic.cycle_us[w, k]
            rest = groups.rate_per_us[group] - traffic.rate_per_us[w]
            share[at, k] = own_rate / (own_rate + rest)
            stages[at, k] = state.stations[w].stages[k]
    neighbour_us = _neighbour_busy_us(senses, relations, traffic)
    on_air_us, overhead_us, after_us = seen_us
    return Interferers(
        share,
        others,
        stages,
        busy_us,
        spare_us,
        sum_on,
        neighbour_us,
        on_air_us,
        overhead_us,
        after_us,
    )


@inlined
def _neighbour_busy_us(senses: FloatArray, relations: Records, traffic: Traffic) -> FloatArray:
    """Return T_nb of the interferer of each relation."""
    own_us = traffic.times.busy_us
    by_station_us = own_us.copy()
    for u in range(len(own_us)):
        busy_us = total = 0.0
        for w in range(len(own_us)):
            busy_us = busy_us + senses[u, w] * (traffic.rate_per_us[w] * own_us[w])
            total = total + senses[u, w] * traffic.rate_per_us[w]
        if total > 0.0:
            by_station_us[u] = busy_us / max(total, 1e-300)
    neighbour_us = np.empty(len(relations))
    for at in range(len(relations)):
        neighbour_us[at] = by_station_us[relations[at].station]
    return neighbour_us


@inlined
def seen_us_of(
    constants: Constants,
    air: Air,
    hidden: Hidden,
    state: State,
    traffic: Traffic,
    kill: FloatArray,
) -> FloatArray:
    """Return T, ovh and ov of each relation as the sender meets them, shape (3, relations)."""
    relations, times = hidden.relations, traffic.times
    extension_us = _ack_extension_us(constants, air.links, hidden, state, kill)
    rts_cts = constants.rts_cts
    answered = _answered(air.links, state)
    seen_us = np.empty((3, len(kill)))
    for at in range(len(kill)):
        w = relations[at].station
        on_air_us, overhead_us = times.on_air_us[w], times.overhead_us[w]
        after_us = overhead_us - extension_us[at]
        if rts_cts:
            waits, part = relations[at].stops_at_cts, answered[w]
            if waits:
                on_air_us = part * BEFORE_CTS_us + (1.0 - part) * RTS_us
                overhead_us = (1.0 - part) * overhead_us
            nav_us = (1.0 - part) * NAV_TIMEOUT_us
            nav_us = nav_us + (0.0 if waits else part * (SIFS_us + ACK_us))
            after_us = overhead_us - (nav_us if relations[at].locks else extension_us[at])
            after_us = max(0.0, after_us)
        seen_us[0, at], seen_us[1, at], seen_us[2, at] = on_air_us, overhead_us, after_us
    return seen_us


@inlined
def _answered(links: Records, state: State) -> FloatArray:
    """Return the part of the RTS of each station that are answered."""
    answered = np.zeros(len(state.stations))
    for link in range(len(links)):
        own = state.links[link]
        answered[links[link].station] += own.attempts * own.answered
    return answered


@inlined
def _ack_extension_us(
    constants: Constants, links: Records, hidden: Hidden, state: State, kill: FloatArray
) -> FloatArray:
    """Return ext, by how much harmful acknowledgements prolong frames."""
    extension_us = np.zeros(len(kill))
    for answer in hidden.answers:
        own = state.links[answer.two]
        each_us = links[answer.two].ack_us * (1.0 - own.loss) * own.attempts
        extension_us[answer.one] += answer.kill * each_us
    for at in range(len(kill)):
        if kill[at] < constants.ack_extension_kill or hidden.relations[at].stops_at_cts:
            extension_us[at] = 0.0
    return extension_us
