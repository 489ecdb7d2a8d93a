"""What packet simulators do besides physics, behind an option.

A station that receives the preamble of j loses its signalling field (L-SIG) if a stronger k, hidden
from j, starts before it has ended. ns-3 then believes the channel idle and counts on.

Source: MODEL 4, L-SIG.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.mac.timing import SLOT_us
from ncsim_wifi.quantities import BoolArray, FloatArray, dBm_from_mW
from ncsim_wifi.spatial.collisions import payload_loss
from ncsim_wifi.spatial.scene import Scene

STRONGER_dB = 2.0
FIELD_us = 20.0  # preamble and L-SIG
BLIND_FROM_us = 67.0  # from the start of k until the channel seems idle for AIFS
WEIGHT = 1.3  # calibrated in MODEL 4


class LostFields(NamedTuple):
    """Who may lose a signalling field, and whom that hurts.

    Args:
        triple: Whether m senses j and a stronger k hidden from j, shape (j, k, m).
        kill: Part of frames of a link that a station destroys from the start, (links, stations).
    """

    triple: BoolArray
    kill: FloatArray


def lost_fields(scene: Scene, noise_mW: FloatArray) -> LostFields | None:
    """Return who may lose a signalling field; ``None`` where the option is off.

    Args:
        scene: The active links.
        noise_mW: Noise and far interferers of each link.
    """
    if not scene.settings.terms.lost_signal_field or scene.settings.rts_cts:
        return None
    at_m_dBm = dBm_from_mW(scene.at_station_mW + 1e-300)
    stronger = at_m_dBm[None, :, :] > at_m_dBm[:, None, :] + STRONGER_dB
    hidden = ~scene.senses
    np.fill_diagonal(hidden, val=False)
    heard = scene.hears_by_power[:, None, :] & scene.hears_by_power[None, :, :]
    return LostFields(stronger & hidden[:, :, None] & heard, payload_loss(scene, noise_mW))


class Senders(NamedTuple):
    """What stations do: R, lambda, T, beta, and C of the occupancy."""

    rate_per_us: FloatArray
    clear_rate_per_us: FloatArray
    on_air_us: FloatArray
    mean_count: FloatArray
    clear: FloatArray


def field_survival(scene: Scene, fields: LostFields, senders: Senders) -> FloatArray:
    """Return what frames of each link survive of stations that believe the channel idle.

    Source: MODEL 4, L-SIG.
    """
    rate, clear = senders.rate_per_us, senders.clear
    soon = -np.expm1(-FIELD_us * senders.clear_rate_per_us)
    blind_us = np.maximum(0.0, senders.on_air_us - BLIND_FROM_us)
    counts_out = np.minimum(1.0, blind_us[:, None] / (2.0 * SLOT_us * senders.mean_count))  # (k, m)
    events = (rate[:, None] * clear * soon)[:, :, None] * clear[:, None, :] * counts_out
    events = np.where(fields.triple, WEIGHT * events, 0.0)
    per_attempt_m = events.transpose(2, 0, 1) / rate[:, None, None]
    own = scene.station
    by_first, by_second = per_attempt_m.sum(axis=2)[own], per_attempt_m.sum(axis=1)[own]
    lost = (by_first * fields.kill).sum(axis=1)  # as m, by j and by k
    lost += (by_second * fields.kill).sum(axis=1)
    lost += ((events.sum(axis=1) / rate[:, None])[own] * fields.kill).sum(axis=1)  # as j, by m
    lost += ((events.sum(axis=0) / rate[:, None])[own] * fields.kill).sum(axis=1)  # as k, by m
    return np.asarray(1.0 - np.minimum(lost, 0.97))
