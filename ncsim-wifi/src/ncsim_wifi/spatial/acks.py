"""Frames lost to acknowledgements of hidden links.

Source: MODEL 3.9.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray, dBm_from_mW
from ncsim_wifi.spatial.hazard import hazard
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.sums import row_products

LEAST_HAZARD = 0.05
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
    """

    link: IntArray
    other: IntArray
    kill: FloatArray


def ack_relations(scene: Scene, hazards: FloatArray, is_hidden: BoolArray) -> AckRelations:
    """Return the relations worth counting.

    Args:
        scene: The active links.
        hazards: h_ack.
        is_hidden: hid[w, l], shape (stations, links).
    """
    counts = is_hidden[scene.station].T & (hazards > LEAST_HAZARD)
    if scene.settings.rts_cts:
        counts &= ~kept_from_answering(scene)
    if not scene.settings.terms.ack_loss:
        counts[:] = False
    link, other = np.nonzero(counts)
    part = scene.ack_us[other] / scene.protected_us[link]
    kill = -np.expm1(-hazards[link, other] * part)
    return AckRelations(link, other, scene.settings.approximations.ack_weight * kill)


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
