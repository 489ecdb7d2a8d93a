"""Frames lost to acknowledgements of hidden links.

Source: MODEL 3.9.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray
from ncsim_wifi.spatial.hazard import hazard
from ncsim_wifi.spatial.scene import Scene

LEAST_HAZARD = 0.05


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
    if not scene.settings.terms.ack_loss:
        counts[:] = False
    link, other = np.nonzero(counts)
    part = scene.ack_us[other] / scene.protected_us[link]
    kill = -np.expm1(-hazards[link, other] * part)
    return AckRelations(link, other, scene.settings.approximations.ack_weight * kill)


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
    return np.asarray((1.0 - kill) ** whole * (1.0 - (expected - whole) * kill))
