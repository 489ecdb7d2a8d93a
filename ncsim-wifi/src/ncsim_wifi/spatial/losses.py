"""What hidden stations leave of frames, from the state of the iteration.

Source: MODEL 3.6 to 3.9.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.mac.timing import ACK_us, RTS_us, SIFS_us
from ncsim_wifi.quantities import FloatArray, IntArray
from ncsim_wifi.spatial.attempts import GAUSS_AT, Exchange
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.elementary import exp, log
from ncsim_wifi.spatial.gaps import Interferers, Survival, Windows, survival, windows_of
from ncsim_wifi.spatial.groups import Members, in_company, in_company_by_cts, met_at_once
from ncsim_wifi.spatial.handshake import BEFORE_CTS_us, NAV_TIMEOUT_us
from ncsim_wifi.spatial.overlap import (
    LARGEST_KILL,
    LARGEST_ON,
    LEAST_KILL,
    LEAST_ON,
    helped_kill,
)
from ncsim_wifi.spatial.relations import Hostile
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.statics import Statics
from ncsim_wifi.spatial.sums import products_by, row_sums


class Traffic(NamedTuple):
    """What stations do in one step of the iteration.

    Args:
        on: A[u, w], probability that w is on while u may count.
        same_slot: p[u, w], probability that w starts in the same slot as u.
        tau: Probability of an attempt per decision.
        rate_per_us: R_u, attempts per time.
        stages: q_u(k), share of attempts in each stage.
        cycle_us: cyc_u(k), mean time between attempts in a stage.
        times: How long exchanges take.
        loss: Share of lost frames of each link.
        attempts: a_l.
        answered: Part of the RTS of each station that are answered.
        sending: How likely w is sending, not only keeping u silent, while u may count.
        link_stages: q_l(k), share of attempts of each link in each stage.
    """

    on: FloatArray
    same_slot: FloatArray
    tau: FloatArray
    rate_per_us: FloatArray
    stages: FloatArray
    cycle_us: FloatArray
    times: Exchange
    loss: FloatArray
    attempts: FloatArray
    answered: FloatArray
    sending: FloatArray
    link_stages: FloatArray


class HiddenLoss(NamedTuple):
    """What each relation does, by stage of the interferer.

    Args:
        survives: s_k, shape (relations, 7).
        answered: Part of RTS that are answered; all without RTS/CTS.
        hit: 1 - nohit_k.
        share: phi_k.
        kill: kd_r, shape (relations,).
        phi: phi_j, share of the interferer in its group.
        alone: Time-weighted stages of the interferer, shape (relations, 7).
        correction: Factor of each link for what else is conditioned on.
        grows: By what loss grows with the sender's own stage, shape (relations, 7).
    """

    survives: FloatArray
    answered: FloatArray
    hit: FloatArray
    share: FloatArray
    kill: FloatArray
    phi: FloatArray
    alone: FloatArray
    correction: FloatArray
    grows: FloatArray


def effective_half_kill(
    statics: Statics, traffic: Traffic, eager: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the part of half overlapped frames that each relation destroys (MODEL 3.7).

    Args:
        statics: Relations.
        traffic: What stations do.
        eager: How much more often than on average the interferer of each relation attempts while
            the sender is in a stage, shape (relations, 7).

    Returns:
        That part, and how loss grows with the sender's stage.
    """
    hostile, times = statics.hostile, traffic.times
    half, grows = statics.alone_half_kill.copy(), np.ones((len(hostile), STAGES))
    some = hostile.with_helpers
    if len(some):
        by_stage = helped_kill(
            statics.helped,
            traffic.on,
            times.on_air_us,
            times.busy_us,
            _of_helpers(statics.helper_relation, eager),
        )
        half[some] = row_sums(traffic.link_stages[hostile.link[some]] * by_stage)
        grows[some] = _whole(by_stage) / np.maximum(_whole(half[some]), 1e-9)[:, None]
        half = np.where(hostile.is_strong, np.maximum(half, statics.alone_half_kill), half)
        grows[hostile.is_strong] = 1.0
    if hostile.has_partners:
        half = half + _partners_kill(hostile, traffic)
    return np.minimum(np.maximum(half, LEAST_KILL), LARGEST_KILL), grows


def _of_helpers(relation: IntArray, eager: FloatArray) -> FloatArray:
    """Return how eager helpers are by stage of the sender; as always where that is not known."""
    return np.where((relation >= 0)[:, :, None], eager[relation], 1.0)


def _whole(half: FloatArray) -> FloatArray:
    """Return the loss of frames overlapped as a whole from that of half overlapped ones."""
    return np.asarray(1.0 - (1.0 - half) ** 2)


def by_own_stage(survives: FloatArray, grows: FloatArray) -> FloatArray:
    """Return what survives a relation in each stage of the sender.

    Args:
        survives: What would, if the relation harmed all stages alike.
        grows: By what loss grows with the stage.
    """
    return np.maximum(0.0, 1.0 - grows * (1.0 - survives))


def _partners_kill(hostile: Hostile, traffic: Traffic) -> FloatArray:
    """Return what is lost as another begins in the same slot as the interferer now and then."""
    together = traffic.same_slot[hostile.station[:, None], hostile.partner] * hostile.partner_kill
    return row_sums(together)


def conditioned_on(
    rivals: tuple[IntArray, IntArray], on: FloatArray, spared: FloatArray
) -> FloatArray:
    """Return A' (or A''), with other (or earlier) hostile groups of the link off (MODEL 3.8).

    Args:
        rivals: Which relations are conditioned on which being off.
        on: A of each relation.
        spared: (1 - A)^kd of each.
    """
    one, two = rivals
    return on / products_by(one, spared[two], len(on)) if len(one) else on


def hidden_loss(
    scene: Scene,
    statics: Statics,
    traffic: Traffic,
    gates: tuple[FloatArray, FloatArray],
    eager: FloatArray,
) -> HiddenLoss:
    """Return what hidden stations do to frames."""
    hostile = statics.hostile
    own, other = statics.own, hostile.station
    half, grows = effective_half_kill(statics, traffic, eager)
    immune = (1.0 - half) * (1.0 - half)
    kill = np.where(hostile.is_strong, 1.0, 1.0 - immune)
    on = np.minimum(np.maximum(traffic.on[own, other], LEAST_ON), 1.0)
    off = 1.0 - np.minimum(on, LARGEST_ON)
    logs = log(np.concatenate([[1.0 - half, off], 1.0 - GAUSS_AT[:, None] * (1.0 - immune)]))
    spared = exp(kill * logs[1])
    later = conditioned_on(statics.rivals.every, on, spared)
    state = _group_state(statics, traffic, later)
    met = _interferers(scene, statics, traffic, kill, state)
    lethal = logs[2:] / (2.0 * logs[0])
    windows = _windows(statics, lethal, immune, gates)
    survives, missed, answered = _fates(statics, survival(met, windows))
    phi, share = state.phi, state.share
    time = traffic.stages[other] * traffic.cycle_us[other]
    alone = time / row_sums(time)[:, None]
    if hostile.has_several:
        hit = 1.0 - row_sums(alone * missed)
        survives = _in_groups(statics, traffic, met, Members(phi, share, alone, survives), hit)
    earlier = conditioned_on(statics.rivals.earlier, on, spared)
    correction = _correction(scene, statics, kill, earlier, later)
    return HiddenLoss(
        np.minimum(np.maximum(survives, 0.0), 1.0),
        np.minimum(np.maximum(np.maximum(answered, survives), 1e-9), 1.0),
        np.minimum(np.maximum(1.0 - missed, 0.0), 1.0),
        share,
        kill,
        phi,
        alone,
        correction,
        grows,
    )


def _in_groups(
    statics: Statics, traffic: Traffic, met: Interferers, members: Members, hit: FloatArray
) -> FloatArray:
    """Return s_k of each relation with its whole group (MODEL 3.8)."""
    hostile = statics.hostile
    if statics.handshakes is not None:
        return in_company_by_cts(hostile, members)
    on_air_us, cycle_us = traffic.times.on_air_us[hostile.station], met.busy_us / met.sum_on
    number = met_at_once(statics.window_us, on_air_us, cycle_us, hit)
    return in_company(hostile, members, number)


def _group_state(statics: Statics, traffic: Traffic, later: FloatArray) -> "GroupState":
    """Return how active the group of each relation is, from A' of its members."""
    other = statics.hostile.station
    rate = traffic.rate_per_us[other]
    sum_rate = statics.hostile.group_sums(rate)
    own_rate = 1.0 / traffic.cycle_us[other]
    share = own_rate / (own_rate + (sum_rate - rate)[:, None])
    return GroupState(
        np.minimum(LARGEST_ON, statics.hostile.group_sums(later)), rate / sum_rate, share
    )


def _windows(
    statics: Statics,
    lethal: FloatArray,
    immune: FloatArray,
    gates: tuple[FloatArray, FloatArray],
) -> Windows:
    """Return the windows in which interferers must not begin (MODEL 3.8)."""
    hostile = statics.hostile
    left_us, borne_us = windows_of(statics.window_us, statics.protected_us, lethal)
    if statics.handshakes is not None:
        left_us = np.concatenate([left_us, statics.handshakes.noticed_us[None]])
    return Windows(left_us, borne_us, immune, hostile.is_strong, *gates, statics.longest_us)


def _fates(statics: Statics, found: Survival) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return s_k and nohit_k of each relation, and what part of RTS are answered."""
    handshakes = statics.handshakes
    if handshakes is None:
        return found.survives, found.missed, np.ones_like(found.survives)
    by_cts = handshakes.by_cts[:, None]
    answered = np.where(statics.hostile.is_strong[:, None], found.found_free, 1.0)
    return (
        np.where(by_cts, handshakes.by_cts_survives, found.survives),
        np.where(by_cts, handshakes.by_cts_missed, found.missed),
        np.where(by_cts, handshakes.by_cts_survives, answered),
    )


def _correction(
    scene: Scene, statics: Statics, kill: FloatArray, earlier: FloatArray, later: FloatArray
) -> FloatArray:
    """Return prod_g max(1, (1 - sum A'' kd) / (1 - sum A' kd)) of each link (MODEL 3.9)."""
    hostile, links = statics.hostile, len(scene.links)
    if not len(statics.rivals.every[0]):
        return np.ones(links)
    free = [
        1.0 - np.minimum(LARGEST_ON, np.bincount(hostile.group, each * kill))
        for each in (earlier, later)
    ]
    return products_by(hostile.link_of_group, np.maximum(1.0, free[0] / free[1]), links)


class GroupState(NamedTuple):
    """How active the group of each relation is: sum of A', phi_j, and phi_k by stage."""

    sum_on: FloatArray
    phi: FloatArray
    share: FloatArray


def _interferers(
    scene: Scene, statics: Statics, traffic: Traffic, kill: FloatArray, state: GroupState
) -> Interferers:
    """Return the interferers of each relation as its link meets them (MODEL 3.8)."""
    other, hostile, times = statics.hostile.station, statics.hostile, traffic.times
    spare_us = (times.overhead_us - times.silent_us)[other]
    return Interferers(
        state.share,
        _nobody_else_starts(hostile, traffic),
        traffic.stages[other],
        hostile.group_sums(state.phi * times.busy_us[other]),
        hostile.group_sums(state.phi * spare_us),
        state.sum_on,
        _neighbour_busy_us(statics, traffic)[other],
        *_seen_us(scene, statics, traffic, kill),
    )


def _nobody_else_starts(hostile: Hostile, traffic: Traffic) -> FloatArray:
    """Return y_o, how likely no other member of the group starts in a slot."""
    if not hostile.has_several:
        return np.ones(len(hostile))
    waits = 1.0 - traffic.tau[hostile.station]
    all_wait = products_by(hostile.group, waits, len(hostile.group_starts))[hostile.group]
    return np.where(hostile.is_member_of_several, all_wait / waits, 1.0)


def _seen_us(
    scene: Scene, statics: Statics, traffic: Traffic, kill: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return T, ovh and ov of the interferer of each relation, as the sender meets them.

    From the CTS on a sender that hears it waits with everybody else. A receiver that has
    locked on an RTS answers nobody until the exchange is over, or was not begun (NAV).
    """
    other, hostile = statics.hostile.station, statics.hostile
    times = traffic.times
    on_air_us, overhead_us = times.on_air_us[other], times.overhead_us[other]
    extension_us = _ack_extension_us(scene, statics, traffic, kill)
    if not scene.settings.rts_cts:
        return on_air_us, overhead_us, overhead_us - extension_us
    answered = traffic.answered[other]
    waits = statics.stops_at_cts
    on_air_us = np.where(waits, answered * BEFORE_CTS_us + (1.0 - answered) * RTS_us, on_air_us)
    overhead_us = np.where(waits, (1.0 - answered) * overhead_us, overhead_us)
    nav_us = (1.0 - answered) * NAV_TIMEOUT_us
    nav_us = nav_us + np.where(waits, 0.0, answered * (SIFS_us + ACK_us))
    extension_us = np.where(hostile.locks, nav_us, extension_us)
    return on_air_us, overhead_us, np.maximum(0.0, overhead_us - extension_us)


def _neighbour_busy_us(statics: Statics, traffic: Traffic) -> FloatArray:
    """Return T_nb, the mean time on the air of what each station senses."""
    own_us = traffic.times.busy_us
    busy_us = row_sums(statics.senses * (traffic.rate_per_us * own_us))
    total = row_sums(statics.senses * traffic.rate_per_us)
    return np.where(total > 0.0, busy_us / np.maximum(total, 1e-300), own_us)


def _ack_extension_us(
    scene: Scene, statics: Statics, traffic: Traffic, kill: FloatArray
) -> FloatArray:
    """Return ext, by how much harmful acknowledgements prolong frames (MODEL 3.8)."""
    hostile = statics.hostile
    each_us = scene.ack_us * (1.0 - traffic.loss) * traffic.attempts
    answers, link = statics.answers_of, statics.answers_of.link
    harm_us = statics.answer_kill * each_us[link]
    extension_us = np.bincount(answers.relation, harm_us, minlength=len(hostile))
    is_harmful = kill >= scene.settings.approximations.ack_extension_kill
    return np.where(is_harmful & ~statics.stops_at_cts, extension_us, 0.0)
