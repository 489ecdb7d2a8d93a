"""What hidden stations leave of frames, from the state of the iteration.

Source: MODEL 3.6 to 3.9.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.mac.timing import ACK_us, RTS_us, SIFS_us, SLOT_us
from ncsim_wifi.quantities import FloatArray, IntArray
from ncsim_wifi.spatial.attempts import Exchange
from ncsim_wifi.spatial.gaps import Gaps, counter_law, mean_remaining_count, survival
from ncsim_wifi.spatial.handshake import BEFORE_CTS_us, CTS_NOTICED_us, NAV_TIMEOUT_us
from ncsim_wifi.spatial.overlap import (
    LARGEST_KILL,
    half_kill,
    joint_kill,
    meets_probability,
    overlap_us,
)
from ncsim_wifi.spatial.relations import Hostile
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.statics import Statics

LARGEST_ON = 0.97
LEAST_ON = 1e-9


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

    @property
    def sending(self) -> FloatArray:
        """Return how likely w is sending, not only keeping u silent, while u may count."""
        return self.on * (self.times.on_air_us / self.times.busy_us)


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
    """

    survives: FloatArray
    answered: FloatArray
    hit: FloatArray
    share: FloatArray
    kill: FloatArray
    phi: FloatArray
    alone: FloatArray
    correction: FloatArray


def effective_hazard(scene: Scene, statics: Statics, traffic: Traffic) -> FloatArray:
    """Return h_r of each relation (MODEL 3.7)."""
    hostile = statics.hostile
    alone = statics.alone_hazard
    half = half_kill(alone)
    some = hostile.with_helpers
    if len(some):
        half[some] = joint_kill(
            hostile.half_kill[some], hostile.omega[some], _helpers_met(scene, statics, traffic)
        )
        half = np.where(hostile.is_strong, np.maximum(half, half_kill(alone)), half)
    if hostile.has_partners:
        half = half + _partners_kill(hostile, traffic)
    return np.maximum(-2.0 * np.log1p(-np.minimum(half, LARGEST_KILL)), 1e-9)


def _helpers_met(scene: Scene, statics: Statics, traffic: Traffic) -> FloatArray:
    """Return x_k of each helper of each relation that has any, 0 where there is none."""
    hostile, times = statics.hostile, traffic.times
    some = hostile.with_helpers
    own, station, helper = statics.own[some], hostile.station[some], hostile.helper[some]
    on_us, busy_us = times.on_air_us, times.busy_us
    on = np.minimum(np.maximum(traffic.on[own, station], LEAST_ON), LARGEST_ON)
    window_us = overlap_us(
        on_us[station],
        busy_us[station] / on,
        scene.protected_us[hostile.link[some]],
        scene.settings.approximations.overlap_scale,
    )
    helper_on = np.minimum(np.maximum(traffic.on[own[:, None], helper], LEAST_ON), LARGEST_ON)
    helper_on = helper_on * (on_us / busy_us)[helper]
    met = meets_probability(helper_on, on_us[helper], window_us[:, None])
    return np.where(helper >= 0, met, 0.0)


def _partners_kill(hostile: Hostile, traffic: Traffic) -> FloatArray:
    """Return what is lost as another begins in the same slot as the interferer now and then."""
    together = traffic.same_slot[hostile.station[:, None], hostile.partner] * hostile.partner_kill
    return np.asarray(np.add.reduce(together, axis=1))


def conditioned_on(
    rivals: tuple[IntArray, IntArray], on: FloatArray, kill: FloatArray
) -> FloatArray:
    """Return A' (or A''), with other (or earlier) hostile groups of the link off (MODEL 3.8).

    Args:
        rivals: Which relations are conditioned on which being off.
        on: A of each relation.
        kill: kd of each.
    """
    one, two = rivals
    if not len(one):
        return on
    logs = kill * np.log1p(-np.minimum(on, LARGEST_ON))
    return on / np.exp(np.bincount(one, logs[two], minlength=len(on)))


def hidden_loss(
    scene: Scene, statics: Statics, traffic: Traffic, gates: tuple[FloatArray, FloatArray]
) -> HiddenLoss:
    """Return what hidden stations do to frames."""
    hostile = statics.hostile
    own, other = statics.own, hostile.station
    hazard = effective_hazard(scene, statics, traffic)
    kill = np.where(hostile.is_strong, 1.0, -np.expm1(-hazard))
    on = np.minimum(np.maximum(traffic.on[own, other], LEAST_ON), 1.0)
    later = conditioned_on(statics.rivals, on, kill)
    state = _group_state(statics, traffic, later)
    gaps = _gaps(scene, statics, traffic, kill, state)
    survives, missed, answered = _fates(scene, statics, gaps, hazard, gates)
    phi, share = state.phi, state.share
    time = traffic.stages[other] * traffic.cycle_us[other]
    alone = time / np.add.reduce(time, axis=1, keepdims=True)
    if hostile.has_several:
        in_group = hostile.group_sums(phi * (alone * survives).sum(axis=1))[:, None]
        several = hostile.is_member_of_several[:, None]
        survives = np.where(several, share * survives + (1.0 - share) * in_group, survives)
    correction = _correction(scene, statics, on, kill, later)
    return HiddenLoss(
        np.minimum(np.maximum(survives, 0.0), 1.0),
        np.minimum(np.maximum(np.maximum(answered, survives), 1e-9), 1.0),
        np.minimum(np.maximum(1.0 - missed, 0.0), 1.0),
        share,
        kill,
        phi,
        alone,
        correction,
    )


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


def _fates(
    scene: Scene,
    statics: Statics,
    gaps: Gaps,
    hazard: FloatArray,
    gates: tuple[FloatArray, FloatArray],
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return s_k and nohit_k of each relation, and what part of RTS are answered."""
    hostile = statics.hostile
    result = survival(
        gaps, statics.window_us, scene.protected_us[hostile.link], hazard, hostile.is_strong
    )
    on_part = gaps.on_air_us[:, None] / gaps.cycle_us
    survives, missed = (_gated(each, on_part, *gates) for each in result)
    if not scene.settings.rts_cts:
        return survives, missed, np.ones_like(survives)
    by_cts = statics.by_cts[:, None]
    return (
        np.where(by_cts, statics.by_cts_survives, survives),
        np.where(by_cts, statics.by_cts_missed, missed),
        np.where(by_cts, statics.by_cts_survives, _answered(statics, gaps)),
    )


def _answered(statics: Statics, gaps: Gaps) -> FloatArray:
    """Return what part of RTS find the receiver free, by stage of the interferer."""
    room_us = gaps.room_us(np.full_like(gaps.after_us, CTS_NOTICED_us))
    return np.where(statics.hostile.is_strong[:, None], room_us / gaps.cycle_us, 1.0)


def _correction(
    scene: Scene, statics: Statics, on: FloatArray, kill: FloatArray, later: FloatArray
) -> FloatArray:
    """Return prod_g max(1, (1 - sum A'' kd) / (1 - sum A' kd)) of each link (MODEL 3.9)."""
    hostile = statics.hostile
    earlier = conditioned_on(statics.earlier_rivals, on, kill)
    sums = [
        np.minimum(LARGEST_ON, np.add.reduceat(each * kill, hostile.group_starts))
        for each in (earlier, later)
    ]
    logs = np.log(np.maximum(1.0, (1.0 - sums[0]) / (1.0 - sums[1])))
    return np.exp(np.bincount(hostile.link_of_group, logs, minlength=len(scene.links)))


def _gated(
    survives: FloatArray, on_part: FloatArray, before: FloatArray, during: FloatArray
) -> FloatArray:
    """Return survival when summed power keeps the two apart part of the time (MODEL 3.8)."""
    before, during = before[:, None], during[:, None]
    at_start = np.minimum(1.0 - survives, on_part)
    lost = at_start * before + (1.0 - survives - at_start) * during
    return np.asarray(1.0 - lost / np.maximum(1.0 - on_part * (1.0 - before), 1e-9))


class GroupState(NamedTuple):
    """How active the group of each relation is: sum of A', phi_j, and phi_k by stage."""

    sum_on: FloatArray
    phi: FloatArray
    share: FloatArray


def _gaps(
    scene: Scene,
    statics: Statics,
    traffic: Traffic,
    kill: FloatArray,
    state: GroupState,
) -> Gaps:
    """Return the gaps between frames of the group of each relation (MODEL 3.8)."""
    other = statics.hostile.station
    times = traffic.times
    others = _nobody_else_starts(statics.hostile, traffic)
    sum_on, phi, share = state
    law = counter_law(share, others)
    busy_us = statics.hostile.group_sums(phi * times.busy_us[other])
    spare_us = statics.hostile.group_sums(phi * (times.overhead_us - times.silent_us)[other])
    counting_us = busy_us * (1.0 / sum_on - 1.0) - spare_us
    mean_count = mean_remaining_count(law)
    counts = np.add.reduce(traffic.stages[other] * mean_count, axis=1)
    count_us = np.maximum(SLOT_us, counting_us / counts)
    neighbour_us = _neighbour_busy_us(statics, traffic)[other]
    interrupted = np.minimum(np.maximum((count_us - SLOT_us) / (neighbour_us - SLOT_us), 0.0), 1.0)
    on_air_us, overhead_us, after_us = _seen_us(scene, statics, traffic, kill)
    longest_us = float(statics.window_us.max())
    return Gaps(
        law, mean_count, on_air_us, after_us, overhead_us, count_us, interrupted, longest_us
    )


def _nobody_else_starts(hostile: Hostile, traffic: Traffic) -> FloatArray:
    """Return y_o, how likely no other member of the group starts in a slot."""
    if not hostile.has_several:
        return np.ones(len(hostile))
    log = np.log1p(-traffic.tau)[hostile.station]
    return np.where(hostile.is_member_of_several, np.exp(hostile.group_sums(log) - log), 1.0)


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
    busy_us = statics.senses @ (traffic.rate_per_us * own_us)
    total = statics.senses @ traffic.rate_per_us
    return np.where(total > 0.0, busy_us / np.maximum(total, 1e-300), own_us)


def _ack_extension_us(
    scene: Scene, statics: Statics, traffic: Traffic, kill: FloatArray
) -> FloatArray:
    """Return ext, by how much harmful acknowledgements prolong frames (MODEL 3.8)."""
    hostile = statics.hostile
    each_us = scene.ack_us * (1.0 - traffic.loss) * traffic.attempts
    answers, link = statics.answers_of, statics.answers_of.link
    harm_us = statics.ack_kill[hostile.link[answers.relation], link] * each_us[link]
    extension_us = np.bincount(answers.relation, harm_us, minlength=len(hostile))
    is_harmful = kill >= scene.settings.approximations.ack_extension_kill
    return np.where(is_harmful & ~statics.stops_at_cts, extension_us, 0.0)
