"""Which hidden stations are looked at one by one, and what becomes of all others.

Others that harm alone count by groups that begin at any time; the rest is noise, as loud as they
are active.

Source: MODEL 2.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray
from ncsim_wifi.spatial.elementary import PER_e_dB, exp, log
from ncsim_wifi.spatial.hazard import hazard
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.sums import products_by, row_sums, starts_of

FAR_ACTIVITY = 0.62
FAR_ACTIVITY_PER_NEIGHBOUR = 0.75
NOBODY = -1
LARGEST_ON = 0.97


class Others(NamedTuple):
    """Harmful stations beyond the nearest ones, by link and group.

    Args:
        link: The link that suffers.
        station: The station it suffers from.
        group: Number of the group, whose members exclude each other on the air.
        harm: Part of overlapped frames that are lost.
        link_of_group: The link of each group.
    """

    link: IntArray
    station: IntArray
    group: IntArray
    harm: FloatArray
    link_of_group: IntArray


NOTHING = np.zeros(0, np.int64)
NO_OTHERS = Others(NOTHING, NOTHING, NOTHING, np.zeros(0), NOTHING)


@dataclass(frozen=True)
class Near:
    """The strongest hidden stations of each link, strongest first, and the noise of the rest.

    Args:
        station: Shape (links, near), ``NOBODY`` where there are fewer.
        power_mW: Their power at the receiver, 0 where there is nobody.
        noise_mW: Noise and far interferers, shape (links,).
        far_mW: Power of the far interferers, which only raise the noise, shape (links, stations).
        others: Stations beyond the nearest that are no mere noise.
    """

    station: IntArray
    power_mW: FloatArray
    noise_mW: FloatArray
    far_mW: FloatArray
    others: Others


def far_activity(degree: FloatArray) -> FloatArray:
    """Return how much of the time a far interferer is taken to be on.

    Source: MODEL 2, near and far interferers.

    Args:
        degree: Number of stations it senses.
    """
    return FAR_ACTIVITY / (1.0 + FAR_ACTIVITY_PER_NEIGHBOUR * degree)


def near_interferers(scene: Scene, is_hidden: BoolArray) -> Near:
    """Return the interferers looked at one by one, and what becomes of all others.

    Others that harm nobody alone only raise the noise.

    Args:
        scene: The active links.
        is_hidden: hid[w, l], shape (stations, links).
    """
    settings = scene.settings
    count = settings.approximations.near_count
    links = len(scene.links)
    rows = np.arange(links)[:, None]
    power_mW = np.where(is_hidden, scene.at_receiver_mW, 0.0).T
    order = np.argsort(-power_mW, axis=1, kind="stable")[:, :count]
    near_mW = power_mW[rows, order]
    far_mW = power_mW.copy()
    far_mW[rows, order] = 0.0
    noise_mW = np.full(links, scene.plant.noise_mW)
    others = NO_OTHERS
    if far_mW.any():
        harm = _harm(scene, far_mW)
        far_mW[harm > 0.0] = 0.0
        if settings.terms.far_noise:
            noise_mW += far_mW @ far_activity(scene.degree)
        else:
            far_mW[:] = 0.0
        if settings.terms.hidden_loss:
            others = _others(scene, harm)
    return Near(np.where(near_mW > 0.0, order, NOBODY), near_mW, noise_mW, far_mW, others)


def _others(scene: Scene, harm: FloatArray) -> Others:
    """Return the harm of stations beyond the nearest, by groups that exclude each other."""
    everybody = np.broadcast_to(np.arange(scene.station_count), harm.shape)
    link, station, group = grouped(harm > 0.0, everybody, scene.senses)
    first = starts_of(group)
    return Others(link, station, group, harm[link, station], link[first])


def _harm(scene: Scene, power_mW: FloatArray) -> FloatArray:
    """Return the loss of frames that one interferer overlaps, 0 where too small to count."""
    settings = scene.settings
    rows = np.arange(len(scene.links))[:, None]
    ratio_dB = scene.ratio_dB(power_mW + scene.plant.noise_mW, rows)
    loss = -np.expm1(-hazard(scene.scheme[:, None], ratio_dB))
    loss = np.where(ratio_dB < settings.preamble_ratio_dB, 1.0, loss)
    counts = (power_mW > 0.0) & (loss >= settings.approximations.min_kill)
    return np.where(counts, loss, 0.0)


def far_noise_survival(scene: Scene, far_mW: FloatArray, sending: FloatArray) -> FloatArray:
    """Return what the noise of far interferers leaves of the frames of each link.

    What the noise floor alone costs is in the clean rate, which the link model decides.

    Args:
        scene: The active links.
        far_mW: Power of each station at each receiver, shape (links, stations).
        sending: How likely w is sending while u may count, shape (stations u, stations w).
    """
    plant = scene.plant
    if not far_mW.any():
        return np.ones(len(scene.links))
    noise_mW = plant.noise_mW + row_sums(far_mW * sending[scene.station])
    whole = hazard(scene.scheme, scene.signal_dBm - PER_e_dB * log(noise_mW))
    return exp(-np.maximum(0.0, whole - plant.noise_hazard[scene.links]))


def others_survival(
    scene: Scene, others: Others, sending: FloatArray, on_air_us: FloatArray
) -> FloatArray:
    """Return what harmful interferers beyond the nearest leave of the frames of each link.

    Args:
        scene: The active links.
        others: Who they are.
        sending: How likely w is sending while u may count, shape (stations u, stations w).
        on_air_us: T of each station.
    """
    if not len(others.link):
        return np.ones(len(scene.links))
    on = others.harm * sending[scene.station[others.link], others.station]
    free = 1.0 - np.minimum(np.bincount(others.group, on), LARGEST_ON)
    part = scene.protected_us[others.link] / on_air_us[others.station]
    begun = np.bincount(others.group, on * part) / free
    return products_by(others.link_of_group, free * exp(-begun), len(scene.links))


def grouped(
    kept: BoolArray, station: IntArray, senses: BoolArray
) -> tuple[IntArray, IntArray, IntArray]:
    """Return link, place and group of the kept relations: each group excludes itself on air."""
    rows, columns = np.nonzero(kept)
    heard = [int.from_bytes(row, "little") for row in np.packbits(senses, 1, "little")]
    cliques: dict[int, list[tuple[int, list[int]]]] = {}  # by link: stations as bits, places above
    stations = station[rows, columns].tolist()
    for at, (link, each) in enumerate(zip(rows.tolist(), stations, strict=True)):
        of_link = cliques.setdefault(link, [])
        unheard = ~heard[each]
        for number, (members, places) in enumerate(of_link):
            if not members & unheard:
                places.append(at)
                of_link[number] = members | 1 << each, places
                break
        else:
            of_link.append((1 << each, [at]))
    in_order = [places for of_link in cliques.values() for _, places in of_link]
    order = np.array([at for clique in in_order for at in clique], np.int64)
    group = np.repeat(np.arange(len(in_order)), [len(clique) for clique in in_order])
    return rows[order], columns[order], group
