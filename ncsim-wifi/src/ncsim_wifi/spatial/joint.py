"""Which pairs of stations have a joint chain, and what relations contribute to it.

Source: MODEL 3.9 and 3.10.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.quantities import FloatArray, IntArray
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.chains import Given, SideRates, joint_stages, stage_means
from ncsim_wifi.spatial.relations import Hostile
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.sums import row_sums


class RelationRates(NamedTuple):
    """What relations do to links, by the interferer's stage: s_b, hit_b and phi_b.

    Args:
        survives: s_b, shape (relations, 7).
        hit: Probability that a frame is overlapped.
        share: phi_b, that the interferer is the one of its group that overlaps.
        grows: By what loss grows with the sender's own stage, relative to its mean.
    """

    survives: FloatArray
    hit: FloatArray
    share: FloatArray
    grows: FloatArray


RawSides = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]
"""s, hit, phi, o and growth of each side of the chains."""


class JointStages:
    """The joint distributions of back-off stages of one scene, as the iteration goes.

    Args:
        scene: The active links.
        hostile: Hidden relations.
    """

    def __init__(self, scene: Scene, hostile: Hostile) -> None:
        self._scene = scene
        self._hostile = hostile
        own = scene.station[hostile.link]
        hurts = np.zeros((scene.station_count, scene.station_count), np.bool_)
        hurts[own, hostile.station] = scene.settings.terms.joint_chains
        one, two = np.nonzero(hurts & hurts.T)
        is_first = one < two
        one, two = one[is_first], two[is_first]
        self.count = len(one)
        side_of = np.full(hurts.shape, -1)
        side_of[one, two] = np.arange(self.count)
        side_of[two, one] = np.arange(self.count) + self.count
        self.side: IntArray = side_of[own, hostile.station]
        self.station = np.concatenate([one, two])
        self.relations = np.flatnonzero(self.side >= 0)
        self._has_one_each = len(self.relations) == 2 * self.count
        self._known = np.zeros(0, np.int64), np.zeros((0, STAGES, STAGES))

    def expected(self, alone: FloatArray, by_stage: FloatArray) -> FloatArray:
        """Return the mean over the stages b of the other, P(b | a), shape (relations, 7).

        Args:
            alone: Time-weighted stages of the interferer of each relation, for want of a chain.
            by_stage: What is averaged, by b, shape (relations, 7).
        """
        return stage_means(Given(alone, *self._known), by_stage)

    def update(
        self,
        attempts: FloatArray,
        total: FloatArray,
        own_part: FloatArray,
        relation: RelationRates,
        cycle_us: FloatArray,
    ) -> None:
        """Solve the chains anew.

        Args:
            attempts: a_l, the share of each link in the attempts of its station.
            total: tot_l(a), success of each link by stage.
            own_part: sbar_r(a), what of it is due to each relation.
            relation: What each relation does.
            cycle_us: cyc_u(k) of each station.
        """
        if not self.count:
            return
        sides = self._sides(attempts, total, own_part, relation)
        half = self.count
        cycles_us = cycle_us[self.station]
        one, two = (_side(sides, cycles_us, part) for part in (slice(0, half), slice(half, None)))
        joint = joint_stages(one, two)
        both = np.concatenate([joint, joint.transpose(0, 2, 1)])
        both /= np.maximum(row_sums(both), 1e-300)[:, :, None]
        self._known = self.relations, both[self.side[self.relations]]

    def _sides(
        self,
        attempts: FloatArray,
        total: FloatArray,
        own_part: FloatArray,
        relation: RelationRates,
    ) -> RawSides:
        """Return the sides of the chains; links that are not hurt contribute s = 1."""
        at = self.relations
        side, link = self.side[at], self._hostile.link[at]
        weight = attempts[link][:, None]
        survives_r, hit_r, share_r, grows_r = (each[at] for each in relation)
        shape = (2 * self.count, STAGES)
        survives, hit, share, grows = np.ones(shape), *np.zeros((3, *shape))
        hurt = np.zeros((2 * self.count, 1))
        self._add(hurt, side, weight)
        self._add(survives, side, weight * (survives_r - 1.0))
        self._add(hit, side, weight * hit_r)
        self._add(share, side, weight * share_r)
        self._add(grows, side, weight * grows_r)
        per_station = self._scene.station_means(attempts, total)
        other = per_station[self.station]
        rest = np.minimum(1.0, total[link] / np.maximum(own_part[at], 1e-12))
        self._add(other, side, weight * (rest - total[link]))
        other = np.minimum(np.maximum(other, 0.0), 1.0)
        return survives, hit, share / hurt, other, grows / hurt

    def _add(self, target: FloatArray, side: IntArray, values: FloatArray) -> None:
        """Add what relations contribute to their sides."""
        if self._has_one_each:
            target[side] += values
        else:
            np.add.at(target, side, values)


def _side(sides: RawSides, cycles_us: FloatArray, part: slice) -> SideRates:
    survives, hit, share, other, grows = (each[part] for each in sides)
    return SideRates(survives, hit, share, other, cycles_us[part], grows)
