"""Stations that are too weak to be sensed one by one, and are sensed together.

Source: MODEL 2 (energy sets) and 3.6.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray, mW_from_dBm
from ncsim_wifi.spatial.near import NOBODY
from ncsim_wifi.spatial.overlap import half_kill
from ncsim_wifi.spatial.relations import Hostile, impossible_subsets, subsets_of
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.sums import column_sums

TINY = 1e-12
KINDS = 4  # of subsets that a gate compares


@dataclass(frozen=True)
class EnergySets:
    """For each station that weak ones can silence together: which of them, and when.

    Args:
        station: The stations silenced.
        row_of: For every station its row here, -1 if it has none.
        member: The weak stations, shape (rows, members), -1 where there are fewer.
        subsets: Which members a subset holds, shape (subsets, members).
        feasible: Whether a subset can be on the air together, shape (rows, subsets).
        blocks: Whether it silences the station.
    """

    station: IntArray
    row_of: IntArray
    member: IntArray
    subsets: BoolArray
    feasible: BoolArray
    blocks: BoolArray


def energy_sets(scene: Scene) -> EnergySets:
    """Return the energy sets of all stations that have one."""
    count = scene.settings.approximations.energy_count
    is_hidden = ~scene.hears_by_power
    np.fill_diagonal(is_hidden, val=False)
    power_mW = np.where(is_hidden, scene.at_station_mW.T, 0.0)  # at u in row u
    member = np.argsort(-power_mW, axis=1, kind="stable")[:, :count]
    member_mW = power_mW[np.arange(len(power_mW))[:, None], member]
    threshold_mW = mW_from_dBm(scene.settings.sensing_dBm)
    station = np.flatnonzero(member_mW.sum(axis=1) >= threshold_mW)
    if not scene.settings.terms.energy_sensing:
        station = station[:0]
    member, member_mW = member[station], member_mW[station]
    size = member.shape[1]
    subsets = subsets_of(size)
    row_of = np.full(scene.station_count, -1)
    row_of[station] = np.arange(len(station))
    return EnergySets(
        station,
        row_of,
        np.where(member_mW > 0.0, member, -1),
        subsets,
        ~impossible_subsets(member, member_mW == 0.0, scene.senses),
        member_mW @ subsets.T >= threshold_mW,
    )


def subset_products(factors: FloatArray) -> FloatArray:
    """Return the product over the members of each subset, shape (subsets, rows).

    Args:
        factors: One for each member, shape (rows, members).
    """
    products = np.ones((1 << factors.shape[1], len(factors)))
    for member, factor in enumerate(factors.T):
        half = 1 << member
        np.multiply(products[:half], factor, out=products[half : 2 * half])
    return products


class GateMasks(NamedTuple):
    """The subsets that gates compare: at the sender of each relation, then at the interferer.

    Args:
        gate: Number of the gate; those left out are open.
        row: The energy set of the station that is silenced.
        subsets: How far it counts as one with the other party of the relation that leaves the
            channel free; as one of all with it; as one without it that leaves it free; as one of
            all without; shape (subsets, gates, 4).
    """

    gate: IntArray
    row: IntArray
    subsets: FloatArray


def gate_masks(scene: Scene, sets: EnergySets, hostile: Hostile) -> GateMasks:
    """Return what the gates compare."""
    own, station = scene.station[hostile.link], hostile.station
    silenced, other = np.concatenate([own, station]), np.concatenate([station, own])
    row = sets.row_of[silenced]
    gate = (
        np.flatnonzero((row >= 0) & (sets.member[row] == other[:, None]).any(axis=1))
        if len(sets.station)
        else np.zeros(0, np.int64)
    )
    it = sets.subsets.astype(np.float64) @ (sets.member[row[gate]] == other[gate][:, None]).T
    is_free = ~sets.blocks[row[gate]].T
    counts = _left_by_rivals(scene, sets, hostile, gate, row[gate])
    masks = np.empty((*it.shape, KINDS))
    np.multiply(it, counts, out=masks[..., 1])
    np.subtract(counts, masks[..., 1], out=masks[..., 3])
    np.multiply(masks[..., 1::2], is_free[..., None], out=masks[..., ::2])
    return GateMasks(gate, row[gate], masks)


def _left_by_rivals(
    scene: Scene, sets: EnergySets, hostile: Hostile, gate: IntArray, row: IntArray
) -> FloatArray:
    """Return what frames survive the rivals in each subset, half overlapped by each.

    At senders only rivals looked at earlier count, so that the gates of a link multiply to that of
    all its relations at once.

    Args:
        scene: The active links.
        sets: Energy sets.
        hostile: Hidden relations.
        gate: Numbers of the gates.
        row: Their energy sets.

    Returns:
        Shape (subsets, gates).
    """
    relation, member = gate % max(1, len(hostile)), sets.member[row]
    number = hostile.numbers(len(scene.links), scene.station_count)
    rival = np.where(member >= 0, number[hostile.link[relation][:, None], member], NOBODY)
    at_sender = (gate < len(hostile))[:, None]
    counts = (rival >= 0) & (rival != relation[:, None])
    counts &= ~at_sender | (rival < relation[:, None])
    kill = np.where(hostile.is_strong, 1.0, half_kill(hostile.delta[:, 0]))
    spared = np.where(counts, 1.0 - kill[rival], 1.0)
    return subset_products(spared)


class Silencing(NamedTuple):
    """Who is silenced by summed power, from tables of a scene.

    Args:
        feasible: 1 where a subset can be on the air together, shape (subsets, rows).
        blocks: 1 where it silences the station.
        gates: Subsets for the gates.
        relation_count: Number of relations.
    """

    feasible: FloatArray
    blocks: FloatArray
    gates: GateMasks
    relation_count: int


class Silenced(NamedTuple):
    """What summed power does.

    Args:
        blocked: B of each station that has an energy set.
        before: al of each relation.
        during: be of each relation, at the beginning.
    """

    blocked: FloatArray
    before: FloatArray
    during: FloatArray


def silencing_of(scene: Scene, sets: EnergySets, hostile: Hostile) -> Silencing:
    """Return the tables of a scene."""
    return Silencing(
        sets.feasible.T.astype(np.float64, order="C"),
        sets.blocks.T.astype(np.float64, order="C"),
        gate_masks(scene, sets, hostile),
        len(hostile),
    )


def silenced_by(tables: Silencing, on: FloatArray) -> Silenced:
    """Return how likely stations are silenced, and the gates that follow.

    Source: MODEL 3.6.

    Args:
        tables: Energy sets.
        on: a, probability that a member is on while the station could send, (rows, members).
    """
    weight = subset_products(on / (1.0 - on))
    weight *= tables.feasible
    sums = column_sums(np.concatenate([weight * tables.blocks, weight], axis=1))
    blocked = sums[: len(on)] / sums[len(on) :]
    gates = open_gates(weight, tables.gates, 2 * tables.relation_count)
    return Silenced(blocked, *np.split(gates, 2))


def open_gates(weights: FloatArray, masks: GateMasks, count: int) -> FloatArray:
    """Return P(not silenced | with it) / P(not silenced | without), at most 1, by gate.

    Source: MODEL 3.6.
    """
    result = np.ones(count)
    if not len(masks.gate):
        return result
    terms = masks.subsets * weights[:, masks.row, None]
    sums = column_sums(terms.reshape(len(terms), -1)).reshape(-1, KINDS).T
    with_it, without = sums[0] / (sums[1] + TINY), sums[2] / (sums[3] + TINY)
    result[masks.gate] = np.minimum(1.0, with_it / np.maximum(without, TINY))
    return result
