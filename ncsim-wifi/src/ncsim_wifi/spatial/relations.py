"""Who destroys whose frames unheard: relations of a link with hidden stations.

Source: MODEL 2.
"""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray
from ncsim_wifi.spatial.hazard import hazard
from ncsim_wifi.spatial.near import NOBODY, Near, grouped
from ncsim_wifi.spatial.scene import Scene

SURVIVAL_DISCOUNT = 0.6
MAX_JOINT_HAZARD = 10.0
RTS_RATIO_dB = 7.0  # a control frame survives a collision above this ratio (MODEL 2)


@dataclass(frozen=True)
class Hostile:
    """All relations r = (link, station) worth counting, by link, group and strength.

    Args:
        link: The link that suffers.
        station: The hidden station that it suffers from.
        is_strong: Whether the station makes the receiver miss any frame that comes later.
        delta: Extra hazard beyond that of each set of helpers, shape (relations, sets).
        omega: Weight of each set of helpers, 0 where the set is impossible.
        helper: Stronger interferers that may act together with it, shape (relations, helpers).
        group: Number of the group of each relation.
        by_cts_only: Whether only the CTS that answer the station reach the receiver.
        locks: Whether the receiver locks on frames of the station.
        partner: Weaker stations that the station senses, and may begin with in the same slot,
            shape (relations, near).
        partner_kill: Extra part of frames lost, half overlapped, if it does.
    """

    link: IntArray
    station: IntArray
    is_strong: BoolArray
    delta: FloatArray
    omega: FloatArray
    helper: IntArray
    group: IntArray
    by_cts_only: BoolArray
    locks: BoolArray
    partner: IntArray
    partner_kill: FloatArray

    def __len__(self) -> int:
        return len(self.link)

    @cached_property
    def group_starts(self) -> IntArray:
        """Return the first relation of each group."""
        return np.flatnonzero(np.diff(self.group, prepend=-1))

    @cached_property
    def links(self) -> IntArray:
        """Return the links that suffer from anybody."""
        return self.link[self.link_starts]

    @cached_property
    def link_starts(self) -> IntArray:
        """Return the first relation of each of these."""
        return np.flatnonzero(np.diff(self.link, prepend=-1))

    @cached_property
    def link_of_group(self) -> IntArray:
        """Return the link that each group belongs to."""
        return self.link[self.group_starts]

    @cached_property
    def is_member_of_several(self) -> BoolArray:
        """Return which relations share their group."""
        return np.bincount(self.group)[self.group] > 1

    @cached_property
    def of_several(self) -> IntArray:
        """Return the relations that share their group."""
        return np.flatnonzero(self.is_member_of_several)

    @cached_property
    def has_several(self) -> bool:
        """Return whether any group has several members."""
        return len(self.group_starts) < len(self)

    @cached_property
    def with_helpers(self) -> IntArray:
        """Return the relations that may act together with others."""
        return np.flatnonzero((self.helper != NOBODY).any(axis=1))

    @cached_property
    def has_partners(self) -> bool:
        """Return whether any interferer may collide with another that harms the link."""
        return bool((self.partner_kill != 0.0).any())

    def group_sums(self, values: FloatArray) -> FloatArray:
        """Return for each relation the sum of its group."""
        if not self.has_several:
            return values
        return np.asarray(np.bincount(self.group, values)[self.group])


def hostile_relations(scene: Scene, near: Near) -> Hostile:
    """Return the relations, with the hazard that each adds to that of stronger interferers.

    The increments of a set of interferers add up to the hazard of the set, so that joint
    interference is attributed to its weakest member and never counted twice.
    """
    settings = scene.settings
    somebody = near.station != NOBODY
    locks = near.power_mW >= 10.0 ** (settings.preamble_dBm / 10.0)
    is_strong, by_cts_only = _strong(scene, near, locks)
    helper = _helpers(scene, near, is_strong)
    sets = subsets_of(settings.approximations.helper_count)
    delta, omega = _increments(scene, near, helper, sets)
    worst = np.where(omega > 0.0, delta, 0.0).max(axis=2)
    partner, partner_kill = _partners(scene, near)
    kept = somebody & (is_strong | (-np.expm1(-worst) >= settings.approximations.min_kill))
    kept &= scene.is_alive[:, None]
    if not settings.terms.hidden_loss:
        kept[:] = False
    link, place, group = grouped(kept, near.station, scene.senses)
    helper_station = np.where(
        helper == NOBODY, NOBODY, np.take_along_axis(near.station[:, None, :], helper, axis=2)
    )
    return Hostile(
        link,
        near.station[link, place],
        is_strong[link, place],
        delta[link, place],
        omega[link, place],
        helper_station[link, place],
        group,
        by_cts_only[link, place],
        locks[link, place],
        partner[link, place],
        partner_kill[link, place],
    )


def _strong(scene: Scene, near: Near, locks: BoolArray) -> tuple[BoolArray, BoolArray]:
    """Return which near ones kill by being on at the start, and which by their CTS alone."""
    settings = scene.settings
    rows = np.arange(len(scene.links))[:, None]
    somebody = near.station != NOBODY
    ratio_dB = scene.ratio_dB(near.power_mW + near.noise_mW[:, None], rows)
    least_dB = RTS_RATIO_dB if settings.rts_cts else settings.preamble_ratio_dB
    is_strong = somebody & (locks | (ratio_dB < least_dB))
    by_cts_only = somebody & ~is_strong & _cts_reaches(scene)[near.station, rows]
    return is_strong | by_cts_only, by_cts_only


def _cts_reaches(scene: Scene) -> BoolArray:
    """Return which receivers hear the CTS that answer which stations, (stations, links)."""
    if not scene.settings.rts_cts:
        return np.zeros((scene.station_count, len(scene.links)), np.bool_)
    heard_mW = 10.0 ** (scene.settings.preamble_dBm / 10.0)
    heard = (scene.receiver_at_receiver_mW >= heard_mW).astype(np.float64)
    return np.asarray(scene.link_of_station.astype(np.float64) @ heard > 0.0)


@cache
def subsets_of(size: int) -> BoolArray:
    """Return all subsets of a few things, the empty one first."""
    return np.array([[bool(held >> i & 1) for i in range(size)] for held in range(1 << size)])


def _helpers(scene: Scene, near: Near, is_strong: BoolArray) -> IntArray:
    """Return Q_r as places among the near ones, shape (links, near, helpers) (MODEL 2)."""
    size = near.station.shape[1]
    able = (near.station != NOBODY) & ~is_strong
    able_before = able[:, None, :] & (np.arange(size)[None, :] < np.arange(size)[:, None])
    able_before &= ~scene.senses[near.station[:, :, None], near.station[:, None, :]]
    if not scene.settings.terms.joint_interference:
        able_before[:] = False
    order = np.argsort(~able_before, axis=2, kind="stable")
    order = order[:, :, : scene.settings.approximations.helper_count]
    chosen = np.take_along_axis(able_before, order, axis=2)
    short = scene.settings.approximations.helper_count - order.shape[2]
    places = np.where(chosen, order, NOBODY)
    return np.pad(places, ((0, 0), (0, 0), (0, short)), constant_values=NOBODY)


def _increments(
    scene: Scene, near: Near, helper: IntArray, sets: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Return Delta_r and omega_r for each set of helpers, shape (links, near, sets)."""
    links = np.arange(len(scene.links))[:, None, None]
    there = helper != NOBODY
    helper_mW = np.where(there, np.take_along_axis(near.power_mW[:, None, :], helper, axis=2), 0.0)
    helper_station = np.take_along_axis(near.station[:, None, :], helper, axis=2)
    together = scene.senses[helper_station[..., :, None], helper_station[..., None, :]]
    together &= there[..., :, None] & there[..., None, :]
    clashes = np.einsum("lnij,si,sj->lns", together, sets, sets) > 0
    lacks = np.einsum("lni,si->lns", ~there, sets) > 0
    set_mW = helper_mW @ sets.T + near.noise_mW[:, None, None]
    before = hazard(scene.scheme[links], scene.ratio_dB(set_mW, links))
    after = hazard(scene.scheme[links], scene.ratio_dB(set_mW + near.power_mW[..., None], links))
    delta = np.minimum(after, MAX_JOINT_HAZARD) - np.minimum(before, MAX_JOINT_HAZARD)
    delta[..., 0] = after[..., 0] - before[..., 0]
    omega = np.where(clashes | lacks, 0.0, np.exp(-SURVIVAL_DISCOUNT * before))
    return np.maximum(delta, 0.0), omega


def _partners(scene: Scene, near: Near) -> tuple[IntArray, FloatArray]:
    """Return who may collide with each interferer, and what both together add to its harm."""
    links = np.arange(len(scene.links))[:, None, None]
    size = near.station.shape[1]
    weaker = np.arange(size)[None, :] > np.arange(size)[:, None]
    there = (near.station != NOBODY)[:, :, None] & (near.station != NOBODY)[:, None, :] & weaker
    there &= scene.senses[near.station[:, :, None], near.station[:, None, :]]
    if not scene.settings.terms.joint_interference or scene.settings.rts_cts:
        there[:] = False  # RTS that collide are over before they harm data
    alone_mW = near.power_mW[:, :, None] + near.noise_mW[:, None, None]
    both_mW = alone_mW + near.power_mW[:, None, :]
    scheme = scene.scheme[links]
    alone, both = (hazard(scheme, scene.ratio_dB(mW, links)) for mW in (alone_mW, both_mW))
    added = np.exp(-alone / 2.0) - np.exp(-both / 2.0)
    station = np.broadcast_to(near.station[:, None, :], there.shape)
    return np.where(there, station, NOBODY), np.where(there, added, 0.0)
