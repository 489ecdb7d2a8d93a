"""What stays the same while the fixed point is approached."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ncsim_wifi.mac.timing import RTS_us
from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray
from ncsim_wifi.spatial.acks import AckRelations, ack_hazard, ack_relations, deaf_to_ack
from ncsim_wifi.spatial.artefacts import LostFields, lost_fields
from ncsim_wifi.spatial.collisions import same_slot_loss
from ncsim_wifi.spatial.energy import EnergySets, Silencing, energy_sets, silencing_of
from ncsim_wifi.spatial.handshake import CTS_NOTICED_us, Handshakes, handshakes_of
from ncsim_wifi.spatial.near import Others, near_interferers
from ncsim_wifi.spatial.occupancy import OccupancyModel, occupancy_of
from ncsim_wifi.spatial.overlap import Helped, half_kill
from ncsim_wifi.spatial.relations import (
    Hostile,
    RTS_RATIO_dB,
    hostile_relations,
)
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.silence import Heard, heard_of

LETHAL_BURST = 0.5  # an RTS that kills the data that it meets; hardly ever in between


class Rivals(NamedTuple):
    """Pairs of relations: all, and those of which the second belongs to an earlier group."""

    every: tuple[IntArray, IntArray]
    earlier: tuple[IntArray, IntArray]


class AnswersOf(NamedTuple):
    """The links of the interferer of each relation, relation by relation."""

    relation: IntArray
    link: IntArray


@dataclass(frozen=True)
class Statics:
    """Relations and tables of one scene.

    Args:
        senses: S as numbers.
        heard: What stations make of exchanges.
        occupancy: Who is on the air together.
        hostile: Hidden relations.
        own: The station that sends on the link of each relation.
        rivals: Which relations of a link are conditioned on which others.
        window_us: V_r, the window in which an interferer must not begin.
        longest_us: The longest window that is asked about.
        alone_kill: Part of frames lost to the interferer of each relation alone.
        alone_half_kill: The part of half overlapped frames that it destroys.
        helped: The relations that may act together with others.
        helper_relation: Relations of the same link with these others, -1 where there is none.
        handshakes: What RTS and CTS change, if they are used.
        fields: Who may lose a signalling field, if that counts.
        stops_at_cts: Whether the sender defers from the interferer's CTS on.
        far_mW: Power of stations that only raise the noise, shape (links, stations).
        others: Harmful stations beyond the nearest.
        same_slot_loss: sync[l, w].
        sensed_loss: The same, 0 of stations that the sender does not sense.
        relation_loss: The same of the interferer of each relation.
        protected_us: V_p of the link of each relation.
        answer_kill: 1 - exp(-h_ack[l, k]) of the following.
        answers_of: Whose acknowledgements may prolong frames of the interferer of a relation.
        acks: Who suffers from whose acknowledgements.
        deaf_to_ack: Part of its own acknowledgements that a sender loses to stations that it does
            not sense, while they send, shape (links, stations).
        energy: Who is silenced by summed power.
        silencing: Tables of these.
        protection_ends: How likely summed power at the interferer ends within a frame.
    """

    senses: FloatArray
    heard: Heard
    occupancy: OccupancyModel
    hostile: Hostile
    own: IntArray
    rivals: Rivals
    window_us: FloatArray
    longest_us: float
    alone_kill: FloatArray
    alone_half_kill: FloatArray
    helped: Helped
    helper_relation: IntArray
    handshakes: Handshakes | None
    fields: LostFields | None
    stops_at_cts: BoolArray
    far_mW: FloatArray
    others: Others
    same_slot_loss: FloatArray
    sensed_loss: FloatArray
    relation_loss: FloatArray
    protected_us: FloatArray
    answer_kill: FloatArray
    answers_of: AnswersOf
    acks: AckRelations
    deaf_to_ack: FloatArray
    energy: EnergySets
    silencing: Silencing
    protection_ends: FloatArray


def statics_of(scene: Scene) -> Statics:
    """Return the relations and tables of a scene."""
    is_hidden = ~scene.hears_by_power[:, scene.station] & ~scene.link_of_station
    near = near_interferers(scene, is_hidden)
    hostile = hostile_relations(scene, near)
    hazards = ack_hazard(scene, near.noise_mW)
    same_slot = same_slot_loss(scene, near.noise_mW)
    answers = AnswersOf(*np.nonzero(scene.link_of_station[hostile.station]))
    own = scene.station[hostile.link]
    alone = hostile.delta[:, 0]
    handshakes = handshakes_of(scene, hostile, RTS_RATIO_dB) if scene.settings.rts_cts else None
    window_us = _windows_us(scene, hostile, handshakes)
    return Statics(
        scene.senses.astype(np.float64),
        heard_of(scene),
        occupancy_of(scene.senses, scene.settings.approximations.max_sets),
        hostile,
        own,
        _rivals(scene, hostile),
        window_us,
        max(window_us.max(initial=0.0), CTS_NOTICED_us),
        -np.expm1(-alone),
        half_kill(alone),
        _helped(scene, hostile),
        _helper_relation(scene, hostile),
        handshakes,
        lost_fields(scene, near.noise_mW),
        _hears_cts_of(scene, own, hostile.station),
        near.far_mW,
        near.others,
        same_slot,
        same_slot * scene.hears_by_power[scene.station],
        same_slot[hostile.link, hostile.station],
        scene.protected_us[hostile.link],
        -np.expm1(-hazards[hostile.link[answers.relation], answers.link]),
        answers,
        ack_relations(scene, hostile, hazards, is_hidden & ~scene.senses[:, scene.station]),
        deaf_to_ack(scene),
        *_summed_power(scene, hostile),
    )


def _summed_power(scene: Scene, hostile: Hostile) -> tuple[EnergySets, Silencing, FloatArray]:
    """Return who is silenced by summed power, and how likely that ends within a frame."""
    energy = energy_sets(scene)
    lasts_us = scene.settings.approximations.helper_cycle_us
    ends = np.exp(-scene.data_us[hostile.link] / lasts_us)
    return energy, silencing_of(scene, energy, hostile), ends


def _helped(scene: Scene, hostile: Hostile) -> Helped:
    """Return the relations that may act together with others."""
    some = hostile.with_helpers
    return Helped(
        scene.station[hostile.link[some]],
        hostile.station[some],
        scene.protected_us[hostile.link[some]],
        hostile.helper[some],
        half_kill(hostile.delta[some]),
        hostile.omega[some],
        scene.settings.approximations.overlap_scale,
    )


def _rivals(scene: Scene, hostile: Hostile) -> Rivals:
    """Return pairs of relations of a link in different groups, the first sensing the second."""
    link = hostile.link
    first, last = link.searchsorted(link, "left"), link.searchsorted(link, "right")
    others = last - first
    one = np.arange(len(link)).repeat(others)
    two = np.arange(len(one)) - (others.cumsum() - last).repeat(others)
    counts = scene.senses[hostile.station[one], hostile.station[two]]
    counts &= hostile.group[one] != hostile.group[two]
    one, two = one[counts], two[counts]
    earlier = hostile.group[two] < hostile.group[one]
    return Rivals((one, two), (one[earlier], two[earlier]))


def _helper_relation(scene: Scene, hostile: Hostile) -> IntArray:
    """Return the relation of each helper with the link it helps to harm, -1 if it has none."""
    number = hostile.numbers(len(scene.links), scene.station_count)
    some = hostile.with_helpers
    helper = hostile.helper[some]
    return np.where(helper >= 0, number[hostile.link[some][:, None], helper], -1)


def _windows_us(scene: Scene, hostile: Hostile, handshakes: Handshakes | None) -> FloatArray:
    """Return V_r (MODEL 2, and 3.8 for RTS/CTS)."""
    link = hostile.link
    window_us = np.where(hostile.is_strong, scene.data_us[link], scene.protected_us[link])
    if handshakes is None:
        return window_us
    hears_cts = scene.hears_receiver[link, hostile.station]
    whole_us = scene.on_air_us[link]
    window_us = np.where(hostile.is_strong, whole_us, window_us)
    burst_kill = -np.expm1(-hostile.delta[:, 0] * RTS_us / scene.protected_us[link])
    by_cts_only = hostile.by_cts_only & (burst_kill < LETHAL_BURST)
    return np.where(hears_cts | by_cts_only, handshakes.noticed_us, window_us)


def _hears_cts_of(scene: Scene, own: IntArray, other: IntArray) -> BoolArray:
    """Return whether a station hears the CTS that answer another, under RTS/CTS."""
    if not scene.settings.rts_cts or not len(own):
        return np.zeros(len(own), np.bool_)
    heard = scene.link_of_station.astype(np.float64) @ scene.hears_receiver.astype(np.float64)
    return np.asarray(heard[other, own] > 0)
