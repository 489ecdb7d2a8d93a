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
        cycles_us = cycle_us[self.station].T
        survives, hit, share, other, grows = sides
        both_sides = SideRates(survives, hit, share, other, cycles_us, grows)
        one = SideRates(*(rate[:, : self.count] for rate in both_sides))
        two = SideRates(*(rate[:, self.count :] for rate in both_sides))
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
    ) -> FloatArray:
        """Return s, hit, phi, o and growth of both sides, shape (5, 7, sides of chains).

        Links that are not hurt contribute s = 1.
        """
        at = self.relations
        side, link = self.side[at], self._hostile.link[at]
        weight, whole = attempts[link], total[link]
        survives, hit, share, grows = (each[at] for each in relation)
        effect = np.empty((len(at), 5, STAGES))
        effect[:, 0] = survives - 1.0
        effect[:, 1], effect[:, 2], effect[:, 4] = hit, share, grows
        effect[:, 3] = np.minimum(1.0, whole / np.maximum(own_part[at], 1e-12)) - whole
        effect *= weight[:, None, None]
        sides = np.zeros((2 * self.count, 5, STAGES))
        sides[:, 0] = 1.0
        sides[:, 3] = self._scene.station_means(attempts, total)[self.station]
        if self._has_one_each:
            sides[side] += effect
        else:
            np.add.at(sides, side, effect)
        sides[:, 2::2] /= np.bincount(side, weight)[:, None, None]
        sides[:, 3] = np.minimum(np.maximum(sides[:, 3], 0.0), 1.0)
        return sides.transpose(1, 2, 0).copy()
