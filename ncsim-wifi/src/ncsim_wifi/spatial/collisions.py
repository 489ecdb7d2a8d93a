"""Frames lost to stations that start in the same slot.

Source: MODEL 2 (same-slot loss) and 3.5.
"""

import numpy as np

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.hazard import hazard
from ncsim_wifi.spatial.relations import RTS_RATIO_dB
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.sums import row_products


def same_slot_loss(scene: Scene, noise_mW: FloatArray) -> FloatArray:
    """Return sync[l, w], the loss of a frame of link l when w starts in the same slot.

    If both RTS are captured, both are answered, and the data collide as a whole.

    Source: MODEL 2.

    Args:
        scene: The active links.
        noise_mW: Noise and far interferers of each link.
    """
    if scene.settings.rts_cts:
        captured = _ratio_dB(scene, noise_mW) >= RTS_RATIO_dB
        of_station = scene.link_of_station / scene.link_of_station.sum(axis=1, keepdims=True)
        other_too = (of_station @ captured).T[scene.station]
        return np.where(captured, other_too * payload_loss(scene, noise_mW), 1.0)
    return payload_loss(scene, noise_mW)


def payload_loss(scene: Scene, noise_mW: FloatArray) -> FloatArray:
    """Return the loss of a data frame of link l that w overlaps as a whole, (links, stations)."""
    ratio_dB = _ratio_dB(scene, noise_mW)
    loss = -np.expm1(-hazard(scene.scheme[:, None], ratio_dB))
    return np.where(ratio_dB < scene.settings.preamble_ratio_dB, 1.0, loss)


def _ratio_dB(scene: Scene, noise_mW: FloatArray) -> FloatArray:
    rows = np.arange(len(scene.links))[:, None]
    return scene.ratio_dB(scene.at_receiver_mW.T + noise_mW[:, None], rows)


def base_success(
    scene: Scene, spared: FloatArray, same_slot: FloatArray, loss: FloatArray
) -> FloatArray:
    """Return base_l, the part of frames that noise and same-slot collisions leave.

    Source: MODEL 3.5.

    Args:
        scene: The active links.
        spared: exp(-h_noise) of each link.
        same_slot: p[u, w].
        loss: sync[l, w], 0 where w is not sensed by power (others by CTS: see losses).
    """
    if not scene.settings.terms.same_slot_collisions:
        return np.where(scene.is_alive, spared, 0.0)
    survivors = row_products(1.0 - same_slot[scene.station] * loss)
    return np.where(scene.is_alive, spared * survivors, 0.0)
