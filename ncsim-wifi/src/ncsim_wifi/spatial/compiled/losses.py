"""What hidden stations leave of frames, relation by relation.

Source: MODEL 3.6 to 3.9; see ``ncsim_wifi.spatial.losses``.
"""

from typing import NamedTuple

import numpy as np
from ncsim_core.compiling import inlined, spliced

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.attempts import GAUSS_AT
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.compiled.elementary import exp, log
from ncsim_wifi.spatial.compiled.gaps import survival
from ncsim_wifi.spatial.compiled.groups import share_groups, share_groups_by_cts
from ncsim_wifi.spatial.compiled.interferers import groups_of, interferers_of, seen_us_of
from ncsim_wifi.spatial.compiled.overlap import helped_kill
from ncsim_wifi.spatial.compiled.state import State, Traffic
from ncsim_wifi.spatial.compiled.tables import Constants, Helpers, Hidden, Records, Tables
from ncsim_wifi.spatial.gaps import Survival, Windows
from ncsim_wifi.spatial.groups import Members
from ncsim_wifi.spatial.losses import HiddenLoss
from ncsim_wifi.spatial.overlap import LARGEST_KILL, LARGEST_ON, LEAST_KILL, LEAST_ON

GAUSS_POINTS = len(GAUSS_AT)


class Harm(NamedTuple):
    """What relations do to frames they overlap, and how often they are on; by relation.

    Args:
        kill: kd.
        immune: exp(-h).
        lethal: Lengths that kill, as part of the payload, shape (3, relations).
        earlier: A''.
        later: A'.
    """

    kill: FloatArray
    immune: FloatArray
    lethal: FloatArray
    earlier: FloatArray
    later: FloatArray


@spliced
def hidden_loss(
    tables: Tables, state: State, traffic: Traffic, gates: tuple[FloatArray, FloatArray]
) -> HiddenLoss:
    """Return what hidden stations do to frames."""
    constants, air, hidden = tables.constants, tables.air, tables.hidden
    relations = hidden.relations
    half, grows = _half_kill(constants, hidden, tables.helpers, state, traffic)
    harm = _harm(hidden, traffic, half)
    groups, phi = groups_of(hidden, traffic, harm.later)
    seen_us = seen_us_of(constants, air, hidden, state, traffic, harm.kill)
    met = interferers_of(air.senses, relations, state, traffic, groups, seen_us)
    found = survival(met, _windows(constants, air.links, relations, harm, gates))
    survives, missed, answered = _fates(constants, relations, found)
    alone = _alone(relations, state, traffic)
    members = Members(phi, met.share, alone, survives)
    if constants.rts_cts:
        share_groups_by_cts(hidden, members)
    else:
        share_groups(hidden, traffic, met, members, missed)
    _clip(survives, answered, missed)
    correction = _correction(hidden, harm, len(air.links))
    return HiddenLoss(
        survives, answered, missed, met.share, harm.kill, phi, alone, correction, grows
    )


@inlined
def _clip(survives: FloatArray, answered: FloatArray, missed: FloatArray) -> None:
    """Make probabilities of what is computed, and hits of misses."""
    for at in range(len(survives)):
        for k in range(STAGES):
            heard = max(answered[at, k], survives[at, k])
            answered[at, k] = min(max(heard, 1e-9), 1.0)
            survives[at, k] = min(max(survives[at, k], 0.0), 1.0)
            missed[at, k] = min(max(1.0 - missed[at, k], 0.0), 1.0)


@inlined
def _half_kill(
    constants: Constants, hidden: Hidden, helpers: Helpers, state: State, traffic: Traffic
) -> tuple[FloatArray, FloatArray]:
    """Return the part of half overlapped frames lost, and how loss grows with the stage."""
    relations = hidden.relations
    half = np.empty(len(relations))
    grows = np.ones((len(half), STAGES))
    scale = constants.overlap_scale
    by_stage = helped_kill(helpers, scale, traffic.on, traffic.times, state.eager)
    for at in range(len(half)):
        half[at] = relations[at].alone_half_kill
    for place in range(len(by_stage)):
        at = helpers.helped[place].relation
        own = state.links[relations[at].link]
        mean = own.stages[0] * by_stage[place, 0]
        for k in range(1, STAGES):
            mean = mean + own.stages[k] * by_stage[place, k]
        if relations[at].is_strong:
            half[at] = max(mean, half[at])
            continue
        half[at] = mean
        least = max(_whole(mean), 1e-9)
        for k in range(STAGES):
            grows[at, k] = _whole(by_stage[place, k]) / least
    for at in range(len(half)):
        half[at] = half[at] + _partners_kill(hidden, traffic.same_slot, at)
        half[at] = min(max(half[at], LEAST_KILL), LARGEST_KILL)
    return half, grows


@inlined
def _whole(half: float) -> float:
    """Return the loss of frames overlapped as a whole from that of half overlapped ones."""
    return 1.0 - (1.0 - half) * (1.0 - half)


@inlined
def _partners_kill(hidden: Hidden, same_slot: FloatArray, at: int) -> float:
    """Return what is lost as another begins in the same slot as the interferer now and then."""
    lost = 0.0
    for place in range(hidden.partner.shape[1]):
        partner = hidden.partner[at, place]
        if partner >= 0:
            meets = same_slot[hidden.relations[at].station, partner]
            lost = lost + meets * hidden.partner_kill[at, place]
    return lost


@inlined
def _harm(hidden: Hidden, traffic: Traffic, half: FloatArray) -> Harm:
    """Return the harm of each relation."""
    relations, count = hidden.relations, len(half)
    kill, immune, on = np.empty(count), np.empty(count), np.empty(count)
    spared, lethal = np.empty(count), np.empty((GAUSS_POINTS, count))
    for at in range(count):
        immune[at] = (1.0 - half[at]) * (1.0 - half[at])
        kill[at] = 1.0 if relations[at].is_strong else 1.0 - immune[at]
        part = traffic.on[relations[at].own, relations[at].station]
        on[at] = min(max(part, LEAST_ON), 1.0)
        spared[at] = exp(kill[at] * log(1.0 - min(on[at], LARGEST_ON)))
        whole = 2.0 * log(1.0 - half[at])
        for number in range(GAUSS_POINTS):
            left = 1.0 - GAUSS_AT[number] * (1.0 - immune[at])
            lethal[number, at] = log(left) / whole
    return Harm(
        kill,
        immune,
        lethal,
        _conditioned_on(hidden.earlier, on, spared),
        _conditioned_on(hidden.every, on, spared),
    )


@inlined
def _conditioned_on(rivals: Records, on: FloatArray, spared: FloatArray) -> FloatArray:
    """Return A' (or A''), with other (or earlier) hostile groups of the link off."""
    product = np.ones(len(on))
    for pair in rivals:
        product[pair.one] *= spared[pair.two]
    for at in range(len(on)):
        product[at] = on[at] / product[at]
    return product


@inlined
def _windows(
    constants: Constants,
    links: Records,
    relations: Records,
    harm: Harm,
    gates: tuple[FloatArray, FloatArray],
) -> Windows:
    """Return the windows in which interferers must not begin."""
    count = len(relations)
    left_us = np.empty((GAUSS_POINTS + 1 + int(constants.rts_cts), count))
    borne_us = np.empty((GAUSS_POINTS, count))
    is_strong = np.empty(count, np.bool_)
    for at in range(count):
        is_strong[at] = relations[at].is_strong
        protected_us = links[relations[at].link].protected_us
        left_us[0, at] = relations[at].window_us
        for number in range(GAUSS_POINTS):
            borne_us[number, at] = min(1.0, harm.lethal[number, at]) * protected_us
            left_us[1 + number, at] = relations[at].window_us - borne_us[number, at]
        if constants.rts_cts:
            left_us[GAUSS_POINTS + 1, at] = relations[at].noticed_us
    return Windows(
        left_us,
        borne_us,
        harm.immune,
        is_strong,
        gates[0],
        gates[1],
        constants.longest_us,
    )


@inlined
def _fates(
    constants: Constants, relations: Records, found: Survival
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return s_k and nohit_k of each relation, and what part of RTS are answered."""
    survives, missed = found.survives, found.missed
    answered = np.ones(survives.shape)
    if not constants.rts_cts:
        return survives, missed, answered
    for at in range(len(survives)):
        for k in range(STAGES):
            if relations[at].by_cts:
                survives[at, k] = relations[at].by_cts_survives[k]
                missed[at, k] = relations[at].by_cts_missed[k]
                answered[at, k] = survives[at, k]
            elif relations[at].is_strong:
                answered[at, k] = found.found_free[at, k]
    return survives, missed, answered


@inlined
def _alone(relations: Records, state: State, traffic: Traffic) -> FloatArray:
    """Return the time-weighted stages of the interferer of each relation."""
    alone = np.empty((len(relations), STAGES))
    for at in range(len(alone)):
        w, total = relations[at].station, 0.0
        for k in range(STAGES):
            alone[at, k] = state.stations[w].stages[k] * traffic.cycle_us[w, k]
            total = total + alone[at, k]
        for k in range(STAGES):
            alone[at, k] /= total
    return alone


@inlined
def _correction(hidden: Hidden, harm: Harm, links: int) -> FloatArray:
    """Return prod_g max(1, (1 - sum A'' kd) / (1 - sum A' kd)) of each link."""
    correction = np.ones(links)
    if not len(hidden.every):
        return correction
    earlier, later = np.zeros((2, len(hidden.link_of_group)))
    for at in range(len(harm.kill)):
        group = hidden.relations[at].group
        earlier[group] += harm.earlier[at] * harm.kill[at]
        later[group] += harm.later[at] * harm.kill[at]
    for group in range(len(later)):
        free = 1.0 - min(LARGEST_ON, earlier[group])
        ratio = free / (1.0 - min(LARGEST_ON, later[group]))
        correction[hidden.link_of_group[group]] *= max(1.0, ratio)
    return correction
