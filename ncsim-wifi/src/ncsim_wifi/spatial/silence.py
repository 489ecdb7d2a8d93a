"""How long stations stay silent after an exchange they heard.

Source: MODEL 3.4.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.mac.timing import AIFS_us
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.handshake import NAV_TIMEOUT_us
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.sums import row_sums

EIFS_AFTER_LOSS_us = 60.2  # EIFS - AIFS beyond AIFS: SIFS + ACK at the slowest rate (MODEL 3.4)
EIFS_WEIGHT = 0.5


class Silence(NamedTuple):
    """Silence after the data frames of each station.

    Args:
        mean_us: b_u, mean over those that sense it; its own overhead if nobody does.
        deviation_us: dev[u, w], how much longer w in particular stays silent.
    """

    mean_us: FloatArray
    deviation_us: FloatArray


class Heard(NamedTuple):
    """What stations make of exchanges, whatever else they do; shape (links, stations).

    Args:
        senses: 1 where stations sense each other, shape (stations, stations).
        answered_us: Their silence after data whose acknowledgement they hear, 0 after others.
        unheard: 1 where they do not hear it.
        noticed_us: Their silence after a frame that they noticed, without acknowledgement.
    """

    senses: FloatArray
    answered_us: FloatArray
    unheard: FloatArray
    noticed_us: FloatArray


def heard_of(scene: Scene) -> Heard:
    """Return what stations make of exchanges (MODEL 3.4)."""
    overhead_us = scene.overhead_us[:, None]
    hears, decodes = (each.astype(np.float64) for each in (scene.hears_receiver, scene.decodes))
    noticed_us = decodes * overhead_us + (1.0 - decodes) * (AIFS_us + EIFS_AFTER_LOSS_us)
    return Heard(scene.senses.astype(np.float64), hears * overhead_us, 1.0 - hears, noticed_us)


def silence_us(heard: Heard, missed: FloatArray) -> FloatArray:
    """Return bl[l, w], how long w stays silent after data of link l.

    Source: MODEL 3.4.

    Args:
        heard: What stations make of exchanges.
        missed: Probability that w was busy when the frame began and never locked on it.
    """
    return heard.answered_us + heard.unheard * (
        missed * AIFS_us + (1.0 - missed) * heard.noticed_us
    )


def silence_of(
    scene: Scene, heard: Heard, clear: FloatArray, attempts: FloatArray, answered: FloatArray
) -> Silence:
    """Return the silence after frames of each station.

    Args:
        scene: The active links.
        heard: What stations make of exchanges.
        clear: C of the occupancy.
        attempts: a_l, the share of each link in the attempts of its station.
        answered: Part of the RTS of each link that are answered, 1 without RTS/CTS.
    """
    missed = np.minimum(np.maximum(1.0 - clear[scene.station], 0.0), 1.0)
    per_link_us = silence_us(heard, missed)
    if scene.settings.rts_cts:
        part = answered[:, None]
        per_link_us = part * per_link_us + (1.0 - part) * (NAV_TIMEOUT_us + AIFS_us)
    overhead_us = scene.station_sums(attempts * scene.overhead_us)
    if not scene.settings.terms.silence:
        return Silence(overhead_us, np.zeros_like(clear))
    per_station_us = scene.station_means(attempts, per_link_us)
    degree = scene.degree
    sums_us = row_sums(per_station_us * heard.senses)
    mean_us = np.where(degree > 0.0, sums_us / np.maximum(degree, 1.0), overhead_us)
    deviation_us = EIFS_WEIGHT * (per_station_us - mean_us[:, None]) * heard.senses
    return Silence(mean_us, deviation_us)
