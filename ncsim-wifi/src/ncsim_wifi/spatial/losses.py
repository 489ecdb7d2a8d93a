"""What hidden stations leave of frames, from the state of the iteration.

Source: MODEL 3.6 to 3.9.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.mac.timing import ACK_us, RTS_us, SIFS_us, SLOT_us
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.attempts import Exchange
from ncsim_wifi.spatial.gaps import Gaps, counter_law, mean_remaining_count, survival
from ncsim_wifi.spatial.handshake import BEFORE_CTS_us, CTS_NOTICED_us, NAV_TIMEOUT_us
from ncsim_wifi.spatial.overlap import LARGEST_KILL, joint_kill, meets_probability, overlap_us
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
    result = statics.alone_hazard.copy()
    some = np.flatnonzero(hostile.has_helpers)
    if len(some):
        own = scene.station[hostile.link[some]]
        station, helper = hostile.station[some], hostile.helper[some]
        on_us, busy_us = traffic.times.on_air_us, traffic.times.busy_us
        on = np.clip(traffic.on, LEAST_ON, LARGEST_ON)
        window_us = overlap_us(
            on_us[station],
            busy_us[station] / on[own, station],
            scene.protected_us[hostile.link[some]],
            scene.settings.approximations.overlap_scale,
        )
        helper_on = on[own[:, None], helper] * (on_us / busy_us)[helper]
        met = meets_probability(helper_on, on_us[helper], window_us[:, None])
        present = np.where(helper >= 0, met, 0.0)
        kill = joint_kill(hostile.delta[some], hostile.omega[some], present, hostile.helper_sets)
        result[some] = -2.0 * np.log1p(-kill)
    result = np.where(hostile.is_strong, np.maximum(result, statics.alone_hazard), result)
    return np.maximum(_with_partners(statics, traffic, result), 1e-9)


def _with_partners(statics: Statics, traffic: Traffic, hazard: FloatArray) -> FloatArray:
    """Return the hazard when another begins in the same slot as the interferer now and then."""
    hostile = statics.hostile
    together = traffic.same_slot[hostile.station[:, None], hostile.partner] * hostile.partner_kill
    kill = -np.expm1(-hazard / 2.0) + together.sum(axis=1)
    return np.asarray(-2.0 * np.log1p(-np.minimum(kill, LARGEST_KILL)))


def group_sums(statics: Statics, values: FloatArray) -> FloatArray:
    """Return for each relation the sum of its group."""
    hostile = statics.hostile
    return np.asarray(np.add.reduceat(values, hostile.group_starts)[hostile.group])


def conditioned_on(
    scene: Scene, statics: Statics, on: FloatArray, kill: FloatArray, *, earlier_only: bool
) -> FloatArray:
    """Return A' (or A''), with other hostile groups of the link off (MODEL 3.8)."""
    hostile = statics.hostile
    one, two = hostile.same_link
    counts = scene.senses[hostile.station[one], hostile.station[two]]
    counts &= hostile.group[one] != hostile.group[two]
    if earlier_only:
        counts &= hostile.group[two] < hostile.group[one]
    logs = kill[two] * np.log1p(-np.minimum(on[two], LARGEST_ON)) * counts
    return on / np.exp(np.bincount(one, logs, minlength=len(on)))


def hidden_loss(
    scene: Scene, statics: Statics, traffic: Traffic, gates: tuple[FloatArray, FloatArray]
) -> HiddenLoss:
    """Return what hidden stations do to frames."""
    hostile = statics.hostile
    own, other = scene.station[hostile.link], hostile.station
    hazard = effective_hazard(scene, statics, traffic)
    kill = np.where(hostile.is_strong, 1.0, -np.expm1(-hazard))
    on = np.clip(traffic.on[own, other], LEAST_ON, 1.0)
    later = conditioned_on(scene, statics, on, kill, earlier_only=False)
    state = _group_state(statics, traffic, later)
    gaps = _gaps(scene, statics, traffic, kill, state)
    survives, missed, answered = _fates(scene, statics, gaps, hazard, gates)
    phi, share = state.phi, state.share
    time = traffic.stages[other] * traffic.cycle_us[other]
    alone = time / time.sum(axis=1, keepdims=True)
    in_group = group_sums(statics, phi * (alone * survives).sum(axis=1))[:, None]
    survives = np.where(
        hostile.is_member_of_several[:, None], share * survives + (1.0 - share) * in_group, survives
    )
    correction = _correction(scene, statics, on, kill, later)
    return HiddenLoss(
        np.clip(survives, 0.0, 1.0),
        np.clip(np.maximum(answered, survives), 1e-9, 1.0),
        np.clip(1.0 - missed, 0.0, 1.0),
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
    sum_rate = group_sums(statics, rate)
    own_rate = 1.0 / traffic.cycle_us[other]
    share = own_rate / (own_rate + (sum_rate - rate)[:, None])
    return GroupState(np.minimum(LARGEST_ON, group_sums(statics, later)), rate / sum_rate, share)


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
    by_cts = statics.by_cts[:, None]
    return (
        np.where(by_cts, statics.by_cts_survives, survives),
        np.where(by_cts, statics.by_cts_missed, missed),
        np.where(by_cts, statics.by_cts_survives, _answered(scene, statics, gaps)),
    )


def _answered(scene: Scene, statics: Statics, gaps: Gaps) -> FloatArray:
    """Return what part of RTS find the receiver free, by stage of the interferer."""
    if not scene.settings.rts_cts:
        return np.ones_like(gaps.mean_us)
    room_us = gaps.room_us(np.full_like(gaps.mean_us, CTS_NOTICED_us))
    return np.where(statics.hostile.is_strong[:, None], room_us / gaps.cycle_us, 1.0)


def _correction(
    scene: Scene, statics: Statics, on: FloatArray, kill: FloatArray, later: FloatArray
) -> FloatArray:
    """Return prod_g max(1, (1 - sum A'' kd) / (1 - sum A' kd)) of each link (MODEL 3.9)."""
    hostile = statics.hostile
    earlier = conditioned_on(scene, statics, on, kill, earlier_only=True)
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
    others_log = group_sums(statics, np.log1p(-traffic.tau[other])) - np.log1p(-traffic.tau[other])
    others = np.where(statics.hostile.is_member_of_several, np.exp(others_log), 1.0)
    sum_on, phi, share = state
    law = counter_law(share, others)
    busy_us = group_sums(statics, phi * times.busy_us[other])
    spare_us = group_sums(statics, phi * (times.overhead_us - times.silent_us)[other])
    counting_us = busy_us * (1.0 / sum_on - 1.0) - spare_us
    counts = (traffic.stages[other] * mean_remaining_count(law)).sum(axis=1)
    count_us = np.maximum(SLOT_us, counting_us / counts)
    interrupted = np.clip(
        (count_us - SLOT_us) / (_neighbour_busy_us(scene, traffic)[other] - SLOT_us), 0.0, 1.0
    )
    on_air_us, overhead_us, after_us = _seen_us(scene, statics, traffic, kill)
    longest_us = float(statics.window_us.max())
    return Gaps(law, on_air_us, after_us, overhead_us, count_us, interrupted, longest_us)


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


def _neighbour_busy_us(scene: Scene, traffic: Traffic) -> FloatArray:
    """Return T_nb, the mean time on the air of what each station senses."""
    weight = scene.senses * traffic.rate_per_us
    busy_us = weight @ traffic.times.busy_us
    own_us = traffic.times.busy_us
    total = weight.sum(axis=1)
    return np.where(total > 0.0, busy_us / np.maximum(total, 1e-300), own_us)


def _ack_extension_us(
    scene: Scene, statics: Statics, traffic: Traffic, kill: FloatArray
) -> FloatArray:
    """Return ext, by how much harmful acknowledgements prolong frames (MODEL 3.8)."""
    hostile = statics.hostile
    each_us = scene.ack_us * (1.0 - traffic.loss) * traffic.attempts
    extension_us = (-np.expm1(-statics.ack_hazard) * each_us) @ scene.link_of_station.T
    extension_us = extension_us[hostile.link, hostile.station]
    is_harmful = kill >= scene.settings.approximations.ack_extension_kill
    return np.where(is_harmful & ~statics.stops_at_cts, extension_us, 0.0)
