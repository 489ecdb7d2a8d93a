"""Who destroys whose frames unheard: relations of a link with hidden stations.

Source: MODEL 2.
"""

from dataclasses import dataclass
from functools import cache, cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray
from ncsim_wifi.spatial.hazard import hazard
from ncsim_wifi.spatial.near import NOBODY, Near, grouped
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.sums import starts_of

Number = TypeVar("Number", np.float64, np.int64)

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
        return starts_of(self.group)

    @cached_property
    def links(self) -> IntArray:
        """Return the links that suffer from anybody."""
        return self.link[self.link_starts]

    @cached_property
    def link_starts(self) -> IntArray:
        """Return the first relation of each of these."""
        return starts_of(self.link)

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

    def numbers(self, links: int, stations: int) -> IntArray:
        """Return the number of the relation of each link with each station, -1 if there is none.

        Args:
            links: Number of links.
            stations: Number of stations.
        """
        number = np.full((links, stations), -1)
        number[self.link, self.station] = np.arange(len(self))
        return number

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
    delta, omega, partner, partner_kill = _increments(scene, near, helper)
    worst = np.where(omega > 0.0, delta, 0.0).max(axis=2)
    kept = somebody & (is_strong | (-np.expm1(-worst) >= settings.approximations.min_kill))
    kept &= scene.is_alive[:, None]
    if not settings.terms.hidden_loss:
        kept[:] = False
    link, place, group = grouped(kept, near.station, scene.senses)
    at = link * near.station.shape[1] + place
    helper = _rows_of(helper, at)
    helper_station = near.station[link[:, None], helper]
    return Hostile(
        link,
        near.station.take(at),
        is_strong.take(at),
        _rows_of(delta, at),
        _rows_of(omega, at),
        np.where(helper == NOBODY, NOBODY, helper_station),
        group,
        by_cts_only.take(at),
        locks.take(at),
        _rows_of(partner, at),
        _rows_of(partner_kill, at),
    )


def _rows_of(values: NDArray[Number], at: IntArray) -> NDArray[Number]:
    """Return some rows of values by link and place, shape (rows, any)."""
    return values.reshape(-1, values.shape[2]).take(at, axis=0)


def _strong(scene: Scene, near: Near, locks: BoolArray) -> tuple[BoolArray, BoolArray]:
    """Return which near ones kill by being on at the start, and which by their CTS alone."""
    settings = scene.settings
    rows = np.arange(len(scene.links))[:, None]
    somebody = near.station != NOBODY
    ratio_dB = scene.ratio_dB(near.power_mW + near.noise_mW[:, None], rows)
    least_dB = RTS_RATIO_dB if settings.rts_cts else settings.preamble_ratio_dB
    is_strong = somebody & (locks | (ratio_dB < least_dB))
    if not settings.rts_cts:
        return is_strong, np.zeros_like(is_strong)
    by_cts_only = somebody & ~is_strong & _cts_reaches(scene)[near.station, rows]
    return is_strong | by_cts_only, by_cts_only


def _cts_reaches(scene: Scene) -> BoolArray:
    """Return which receivers hear the CTS that answer which stations, (stations, links)."""
    heard_mW = 10.0 ** (scene.settings.preamble_dBm / 10.0)
    heard = (scene.receiver_at_receiver_mW >= heard_mW).astype(np.float64)
    return np.asarray(scene.link_of_station.astype(np.float64) @ heard > 0.0)


@cache
def subsets_of(size: int) -> BoolArray:
    """Return all subsets of a few things, the empty one first."""
    return np.array([[bool(held >> i & 1) for i in range(size)] for held in range(1 << size)])


@cache
def _impossible(size: int) -> tuple[IntArray, IntArray, FloatArray]:
    """Return what makes subsets of a few things impossible.

    Returns:
        The first and the second thing of each pair, and a table of 1 where a subset holds both
        of a pair, and below where it holds a thing, shape (pairs + size, subsets).
    """
    held = subsets_of(size).T.astype(np.float64)
    first, second = np.triu_indices(size, 1)
    return first, second, np.concatenate([held[first] * held[second], held])


def impossible_subsets(station: IntArray, lacks: BoolArray, senses: BoolArray) -> BoolArray:
    """Return which subsets of a few stations cannot be on the air together.

    Args:
        station: The stations, shape (..., size); the last are lacking.
        lacks: Which of them are not there.
        senses: Who senses whom.

    Returns:
        Shape (..., subsets).
    """
    first, second, table = _impossible(station.shape[-1])
    clashes = senses[station[..., first], station[..., second]]
    return np.asarray(np.concatenate([clashes, lacks], axis=-1).astype(np.float64) @ table > 0.0)


def _helpers(scene: Scene, near: Near, is_strong: BoolArray) -> IntArray:
    """Return Q_r as places among the near ones, shape (links, near, helpers) (MODEL 2)."""
    links, size = near.station.shape
    able = (near.station != NOBODY) & ~is_strong
    able_before = able[:, None, :] & (np.arange(size)[None, :] < np.arange(size)[:, None])
    able_before &= ~scene.senses[near.station[:, :, None], near.station[:, None, :]]
    if not scene.settings.terms.joint_interference:
        able_before[:] = False
    count = scene.settings.approximations.helper_count
    order = np.argsort(~able_before, axis=2, kind="stable")[:, :, :count]
    rows = np.arange(links)[:, None, None]
    chosen = able_before[rows, np.arange(size)[:, None], order]
    places = np.full((links, size, count), NOBODY)
    places[:, :, :size] = np.where(chosen, order, NOBODY)
    return places


def _increments(
    scene: Scene, near: Near, helper: IntArray
) -> tuple[FloatArray, FloatArray, IntArray, FloatArray]:
    """Return Delta_r and omega_r for each set of helpers, and who may collide with interferers.

    Returns:
        Both of shape (links, near, sets); stations that may begin together with the interferer,
        and what both together add to its harm, shape (links, near, near).
    """
    links = np.arange(len(scene.links))[:, None, None]
    there = helper != NOBODY
    sets = subsets_of(helper.shape[2])
    set_mW = np.where(there, near.power_mW[links, helper], 0.0) @ sets.T
    set_mW += near.noise_mW[:, None, None]
    with_it_mW = set_mW + near.power_mW[..., None]
    both_mW = with_it_mW[..., :1] + near.power_mW[:, None, :]
    every_mW = np.concatenate([set_mW, with_it_mW, both_mW], axis=2)
    hazards = hazard(scene.scheme[links], scene.ratio_dB(every_mW, links))
    count = len(sets)
    before, after, both = (
        hazards[..., :count], hazards[..., count : 2 * count], hazards[..., 2 * count :]
    )  # fmt: skip
    delta = np.minimum(after, MAX_JOINT_HAZARD) - np.minimum(before, MAX_JOINT_HAZARD)
    delta[..., 0] = after[..., 0] - before[..., 0]
    is_impossible = impossible_subsets(near.station[links, helper], ~there, scene.senses)
    omega = np.where(is_impossible, 0.0, np.exp(-SURVIVAL_DISCOUNT * before))
    added = np.exp(-after[..., :1] / 2.0) - np.exp(-both / 2.0)
    return np.maximum(delta, 0.0), omega, *_partners(scene, near, added)


def _partners(scene: Scene, near: Near, added: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return who may collide with each interferer, and what both together add to its harm.

    Args:
        scene: The active links.
        near: The interferers.
        added: What two of them would add.
    """
    size = near.station.shape[1]
    is_somebody = near.station != NOBODY
    there = is_somebody[:, :, None] & is_somebody[:, None, :]
    there &= np.arange(size)[None, :] > np.arange(size)[:, None]
    there &= scene.senses[near.station[:, :, None], near.station[:, None, :]]
    if not scene.settings.terms.joint_interference or scene.settings.rts_cts:
        there[:] = False  # RTS that collide are over before they harm data
    return np.where(there, near.station[:, None, :], NOBODY), np.where(there, added, 0.0)
