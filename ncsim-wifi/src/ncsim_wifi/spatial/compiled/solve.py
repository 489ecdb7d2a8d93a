"""Steps of the fixed point, compiled as a whole.

Source: MODEL 3 and 6; see ``ncsim_wifi.spatial.solve``.
"""

import numpy as np
from ncsim_core.compiling import inlined, spliced

from ncsim_wifi.mac.timing import RTS_us, SLOT_us
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.attempts import Attempts, Contenders, Exchange
from ncsim_wifi.spatial.backoff import MEAN_COUNTS, STAGES
from ncsim_wifi.spatial.compiled.acks import (
    fill_spared,
    lose_answers,
    none_overlapped,
    overlapped,
)
from ncsim_wifi.spatial.compiled.attempts import attempts_of
from ncsim_wifi.spatial.compiled.backoff import visit
from ncsim_wifi.spatial.compiled.chains import stage_means
from ncsim_wifi.spatial.compiled.collisions import base_success, partner_collisions
from ncsim_wifi.spatial.compiled.elementary import exp, log
from ncsim_wifi.spatial.compiled.energy import gates_of
from ncsim_wifi.spatial.compiled.handshake import learn_handshake
from ncsim_wifi.spatial.compiled.joint import learn_chains, sides_of
from ncsim_wifi.spatial.compiled.losses import hidden_loss
from ncsim_wifi.spatial.compiled.occupancy import occupancy_of
from ncsim_wifi.spatial.compiled.silence import learn_silence
from ncsim_wifi.spatial.compiled.state import State, Traffic
from ncsim_wifi.spatial.compiled.tables import Constants, Records, Tables
from ncsim_wifi.spatial.losses import HiddenLoss
from ncsim_wifi.spatial.occupancy import Occupancy
from ncsim_wifi.spatial.overlap import LARGEST_ON
from ncsim_wifi.spatial.solve import LEAST_ACTIVITY, STEPS_WITH_CHAINS


@spliced
def advance(tables: Tables, state: State, first: int, stop: int) -> FloatArray:
    """Go some steps; return R_u of the last."""
    rate_per_us = np.zeros(len(state.stations))
    for number in range(first, stop):
        rate_per_us = _step(tables, state, number)
    return rate_per_us


@spliced
def _step(tables: Tables, state: State, number: int) -> FloatArray:
    """Go one step; return R_u."""
    constants, air, count = tables.constants, tables.air, len(state.stations)
    times = _exchange(constants, air.links, state)
    counts, tau, able = np.empty(count), np.empty(count), np.empty(count)
    for u in range(count):
        own = state.stations[u]
        counts[u] = own.stages[0] * MEAN_COUNTS[0]
        for k in range(1, STAGES):
            counts[u] = counts[u] + own.stages[k] * MEAN_COUNTS[k]
        tau[u] = 1.0 / (1.0 + counts[u])
        able[u] = own.activity * ((1.0 - own.blocked) * (1.0 - min(own.silenced, LARGEST_ON)))
    contenders = Contenders(air.senses, tau, state.clear, able, constants.rts_cts)
    attempts = attempts_of(contenders, times)
    activity = np.empty(count)
    for u in range(count):
        activity[u] = max(attempts.activity[u], LEAST_ACTIVITY)
    occupancy = occupancy_of(air.graph, air.senses, activity)
    gain = constants.gain
    for u in range(count):
        for w in range(count):
            clear = min(occupancy.clear[u, w], 1.0)
            state.clear[u, w] = gain * clear + (1.0 - gain) * state.clear[u, w]
    traffic = _traffic(counts, tau, attempts, occupancy, times)
    learn_silence(constants, air, times.overhead_us, state)
    success = _success_by_stage(tables, state, traffic, number)
    visit(constants.stage_gain, air.links, state, success)
    return traffic.rate_per_us


@inlined
def _exchange(constants: Constants, links: Records, state: State) -> Exchange:
    """Return T_u, ovh_u and the silence after frames, averaged over links."""
    count = len(state.stations)
    on_air_us, overhead_us = np.zeros(count), np.zeros(count)
    silent_us, busy_us = np.empty(count), np.empty(count)
    for link in range(len(links)):
        own, u, link_us = state.links[link], links[link].station, links[link].on_air_us
        if constants.rts_cts:
            link_us = own.answered * link_us + (1.0 - own.answered) * RTS_us
        on_air_us[u] += own.attempts * link_us
        overhead_us[u] += own.attempts * links[link].overhead_us
    for u in range(count):
        silent_us[u] = state.stations[u].silent_us
        busy_us[u] = on_air_us[u] + silent_us[u]
    return Exchange(on_air_us, overhead_us, silent_us, state.deviation_us, busy_us)


@inlined
def _traffic(
    counts: FloatArray, tau: FloatArray, attempts: Attempts, occupancy: Occupancy, times: Exchange
) -> Traffic:
    """Return R_u, D_u and cyc_u."""
    count = len(counts)
    rate_per_us, cycle_us = np.empty(count), np.empty((count, STAGES))
    sending = np.empty((count, count))
    for u in range(count):
        rate_per_us[u] = attempts.rate_per_us[u] * occupancy.idle[u]
        base_us = times.on_air_us[u] + times.overhead_us[u]
        count_us = max(SLOT_us, (1.0 / rate_per_us[u] - base_us) / counts[u])
        for k in range(STAGES):
            cycle_us[u, k] = base_us + MEAN_COUNTS[k] * count_us
        for w in range(count):
            sending[u, w] = occupancy.on[u, w] * (times.on_air_us[w] / times.busy_us[w])
    return Traffic(occupancy.on, attempts.same_slot, tau, rate_per_us, cycle_us, times, sending)


@spliced
def _success_by_stage(tables: Tables, state: State, traffic: Traffic, number: int) -> FloatArray:
    """Return what links deliver by stage; bring chains and what others wait for up to date."""
    constants, air, hidden = tables.constants, tables.air, tables.hidden
    base = base_success(constants, air, state, traffic)
    gates = gates_of(constants, tables.energy, hidden.relations, state, traffic)
    spared = np.ones((len(air.links), len(air.senses)))
    if not len(hidden.relations):
        lose_answers(constants, air, state, traffic, (none_overlapped(), spared), base)
        return _evenly(base)
    loss = hidden_loss(tables, state, traffic, gates)
    partner_collisions(air, hidden.relations, state, traffic, gates[1], base)
    fill_spared(constants, hidden.relations, loss.kill, spared)
    met = overlapped(constants, hidden.relations, loss)
    heard = lose_answers(constants, air, state, traffic, (met, spared), base)
    known, sent = hidden.chain_of[: state.known[0]], (loss.survives, loss.grows)
    success, parts = _success(hidden.relations, base, loss, sent, (known, state.given))
    with_chains = number < STEPS_WITH_CHAINS or number % 2 == 0
    if with_chains and len(hidden.chain_of):
        sides = sides_of(air, hidden, state, loss, traffic.cycle_us, (success, parts))
        learn_chains(hidden, state, sides)
        known = hidden.chain_of[: state.known[0]]
        success, parts = _success(hidden.relations, base, loss, sent, (known, state.given))
        if constants.helpers_by_stage:
            _learn_eagerness(hidden.relations, state, traffic, loss.alone, known)
    if constants.rts_cts:
        asked = loss.answered, np.ones(loss.grows.shape)
        by_stage, parts = _success(hidden.relations, heard, loss, asked, (known, state.given))
        learn_handshake(constants.gain, air, state, traffic, by_stage)
    return success


@inlined
def _evenly(base: FloatArray) -> FloatArray:
    """Return what does not depend on the stage."""
    by_stage = np.empty((len(base), STAGES))
    for link in range(len(base)):
        for k in range(STAGES):
            by_stage[link, k] = base[link]
    return by_stage


@inlined
def _success(
    relations: Records,
    base: FloatArray,
    loss: HiddenLoss,
    frames: tuple[FloatArray, FloatArray],
    known: tuple[Records, FloatArray],
) -> tuple[FloatArray, FloatArray]:
    """Return tot_l(a), and sbar_r(a) of each relation.

    Args:
        relations: The relations.
        base: What else leaves of the frames of each link.
        loss: What relations do.
        frames: What of them survives each relation, and how loss grows with the stage.
        known: The relations with a chain, and P(b | a) of each.
    """
    parts = stage_means(loss.alone, known[0], known[1], frames[0])
    whole = np.ones((len(base), STAGES))
    for at in range(len(parts)):
        for k in range(STAGES):
            part = max(0.0, 1.0 - frames[1][at, k] * (1.0 - parts[at, k]))
            parts[at, k], factor = part, max(part, 1e-12)
            if relations[at].has_company:
                factor = exp(loss.phi[at] * log(factor))
            whole[relations[at].link, k] *= factor
    for link in range(len(base)):
        for k in range(STAGES):
            whole[link, k] = min(1.0, whole[link, k] * loss.correction[link])
            whole[link, k] = base[link] * whole[link, k]
    return whole, parts


@inlined
def _learn_eagerness(
    relations: Records, state: State, traffic: Traffic, alone: FloatArray, known: Records
) -> None:
    """Update how often interferers attempt while a sender is in each stage."""
    rate_per_us = np.empty(alone.shape)
    for at in range(len(alone)):
        for k in range(STAGES):
            rate_per_us[at, k] = 1.0 / traffic.cycle_us[relations[at].station, k]
    by_stage_per_us = stage_means(alone, known, state.given, rate_per_us)
    for at in range(len(alone)):
        mean_per_us = 0.0
        for k in range(STAGES):
            mean_per_us = mean_per_us + alone[at, k] * rate_per_us[at, k]
        for k in range(STAGES):
            state.eager[at, k] = by_stage_per_us[at, k] / mean_per_us
