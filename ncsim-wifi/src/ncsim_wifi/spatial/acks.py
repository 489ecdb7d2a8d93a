"""Frames lost to acknowledgements of hidden links.

Source: MODEL 3.9.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.mac.timing import SIFS_us
from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray, dBm_from_mW
from ncsim_wifi.spatial.hazard import hazard
from ncsim_wifi.spatial.relations import Hostile
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.sums import row_products

LEAST_HAZARD = 0.05
LEAST_PART = 1e-6
MOST_ANSWERS = 9.0
CONTROL_RATIOS_dB = np.array([0.0, 6.0, 6.5, 7.0, 7.5, 8.0, 8.5, 9.0, 10.0])
CONTROL_LN_HAZARDS = np.log([20.0, 1.6, 1.04, 0.474, 0.214, 0.081, 0.023, 0.0088, 1e-4])


def ack_hazard(scene: Scene, noise_mW: FloatArray) -> FloatArray:
    """Return h_ack[l, k], the hazard of the acknowledgements of link k to frames of link l.

    Source: MODEL 3.8 and 3.9.
    """
    rows = np.arange(len(scene.links))[:, None]
    ratio_dB = scene.ratio_dB(scene.receiver_at_receiver_mW.T + noise_mW[:, None], rows)
    return hazard(scene.scheme[:, None], ratio_dB)


class AckRelations(NamedTuple):
    """Which links suffer from the acknowledgements of which.

    Args:
        link: The links that suffer.
        other: The links whose acknowledgements do harm.
        kill: Probability that one of them destroys a frame it falls into.
        window_us: For how long the frame is exposed.
        later_us: The same where the data that are answered have overlapped it before.
        data: The relation of the link with the station that they answer, -1 if there is none.
        back: The relation of that station's link with the own one, -1 if there is none.
    """

    link: IntArray
    other: IntArray
    kill: FloatArray
    window_us: FloatArray
    later_us: FloatArray
    data: IntArray
    back: IntArray


def ack_relations(
    scene: Scene, hostile: Hostile, hazards: FloatArray, is_hidden: BoolArray
) -> AckRelations:
    """Return the relations worth counting.

    Args:
        scene: The active links.
        hostile: Hidden relations.
        hazards: h_ack.
        is_hidden: hid[w, l], shape (stations, links).
    """
    counts = is_hidden[scene.station].T & (hazards > LEAST_HAZARD)
    if scene.settings.rts_cts:
        counts &= ~kept_from_answering(scene)
    if not scene.settings.terms.ack_loss:
        counts[:] = False
    link, other = np.nonzero(counts)
    window_us, each_us = scene.protected_us[link], scene.ack_us[other]
    kill = -np.expm1(-hazards[link, other] * each_us / window_us)
    if scene.settings.rts_cts:
        window_us, kill = window_us + each_us, scene.settings.approximations.ack_weight * kill
    number, own = hostile.numbers(len(scene.links), scene.station_count), scene.station
    return AckRelations(
        link,
        other,
        kill,
        window_us,
        np.maximum(0.0, window_us - SIFS_us - each_us / 2.0),
        number[link, own[other]],
        number[other, own[link]],
    )


def kept_from_answering(scene: Scene) -> BoolArray:
    """Return whose receivers answer nobody during the data of which links, under RTS/CTS.

    They hear the RTS or the CTS that precede them, and defer (NAV).

    Source: 802.11-2020, 10.3.2.4 and 10.3.2.9.

    Returns:
        Shape (links that send data, links that would be answered).
    """
    heard_mW = 10.0 ** (scene.settings.preamble_dBm / 10.0)
    hears_rts = scene.at_receiver_mW[scene.station] >= heard_mW
    hears_cts = scene.receiver_at_receiver_mW >= heard_mW
    return np.asarray(hears_rts | hears_cts)


def ack_survival(expected: FloatArray, kill: FloatArray) -> FloatArray:
    """Return f, what frames survive if a number of acknowledgements falls into each.

    The number is taken to vary as little as it can.

    Source: MODEL 3.9.

    Args:
        expected: n, the mean number.
        kill: kappa_a, the harm of one.
    """
    whole = np.floor(expected)
    kill = np.minimum(kill, 1.0)
    spared = 1.0 - (expected - whole) * kill
    for number in range(int(whole.max(initial=0.0))):
        spared = np.where(whole > number, spared * (1.0 - kill), spared)
    return spared


class Overlapped(NamedTuple):
    """What becomes of frames that hidden relations may overlap, on average.

    Args:
        hit: Part of frames that the relation overlaps.
        survives: Part that survives it.
        prolongs: Whether the acknowledgement is taken to prolong the data it answers.
        left: Part that is left for other acknowledgements to harm.
    """

    hit: FloatArray
    survives: FloatArray
    prolongs: BoolArray
    left: FloatArray


def answers_survival(acks: AckRelations, rate_per_us: FloatArray, met: Overlapped) -> FloatArray:
    """Return what acknowledgements leave of frames, by relation.

    An acknowledgement that prolongs its data falls into frames that overlap these, of which some
    survive. It is sent if what it answers survives the overlap as well.

    Source: MODEL 3.9.

    Args:
        acks: Who suffers from whose.
        rate_per_us: How many there are.
        met: What becomes of overlapped frames, by hidden relation.
    """
    none = np.ones(1)  # number -1
    hit, survives = np.append(met.hit, none), np.append(met.survives, none)
    hit, survives = np.maximum(hit, LEAST_PART), np.maximum(survives, LEAST_PART)
    of_survivors = np.maximum(0.0, survives - (1.0 - hit)) / survives
    is_sent = np.minimum(1.0, of_survivors / hit)[acks.back]
    in_overlapped = rate_per_us * acks.later_us / hit[acks.data] * is_sent
    spared = ack_survival(np.minimum(in_overlapped, MOST_ANSWERS), acks.kill)
    among = of_survivors[acks.data]
    is_later = np.append(met.prolongs, np.zeros(1, np.bool_))[acks.data]
    left = np.append(met.left, none)[acks.data]
    in_any = ack_survival(rate_per_us * acks.window_us, acks.kill * left)
    return np.where(is_later, 1.0 - among + among * spared, in_any)


def deaf_to_ack(scene: Scene) -> FloatArray:
    """Return the part of acknowledgements of l lost while w sends that its sender does not sense.

    Returns:
        Shape (links, stations).
    """
    own = scene.station
    answer_dBm = scene.receiver_at_station_dBm[np.arange(len(own)), own]
    other_mW = scene.at_station_mW.T[own]
    ratio_dB = answer_dBm[:, None] - dBm_from_mW(other_mW + scene.plant.noise_mW)
    hidden = ~scene.senses[own] & ~scene.link_of_station.T
    if not scene.settings.terms.ack_loss:
        hidden[:] = False
    return np.where(hidden & (other_mW > 0.0), -np.expm1(-control_hazard(ratio_dB)), 0.0)


def control_hazard(ratio_dB: FloatArray) -> FloatArray:
    """Return the hazard of a control frame of 14 to 20 bytes at 24 Mb/s.

    Source: measured here: answers to RTS of one link in ns-3.44, by noise figure.
    """
    return np.asarray(np.exp(np.interp(ratio_dB, CONTROL_RATIOS_dB, CONTROL_LN_HAZARDS)))


def heard_answers(deaf: FloatArray, sending: FloatArray) -> FloatArray:
    """Return the part of acknowledgements that senders receive.

    Args:
        deaf: What a station spoils while it sends, shape (links, stations).
        sending: How likely it sends although the data were received.
    """
    part = np.minimum(np.maximum(sending, 0.0), 1.0)
    return row_products(1.0 - deaf * part)
