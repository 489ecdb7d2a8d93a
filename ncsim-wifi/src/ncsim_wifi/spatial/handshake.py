"""What RTS and CTS change: short failures, and stations silenced by a CTS alone.

An exchange of two stations that hear each other's CTS, and not each other, is decided in a few
slots: counters run in step after each exchange, an RTS lasts 3.1 slots, and the CTS that
silences the other is noticed after 5.3. Counting the slots in which a start of the other is
fatal gives what a handshake survives.

Source: 802.11-2020, 10.3.2.4 (NAV) and 10.3.2.9 (RTS/CTS); docs/csma-spatial.md.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.mac.timing import AIFS_us, CTS_us, RTS_us, SIFS_us, SLOT_us
from ncsim_wifi.quantities import BoolArray, FloatArray, dBm_from_mW
from ncsim_wifi.spatial.backoff import WINDOWS
from ncsim_wifi.spatial.hazard import hazard
from ncsim_wifi.spatial.relations import Hostile
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.sums import row_products, row_sums

DETECTION_us = 4.0  # of a preamble
PHY_RX_START_us = 20.0  # of a legacy OFDM frame
CTS_NOTICED_us = RTS_us + SIFS_us + DETECTION_us  # after the start of the RTS
BEFORE_CTS_us = RTS_us + SIFS_us
ACK_TIMEOUT_us = 45.0
# who decoded an RTS is free again if nothing follows it for this long (NAVTimeout)
NAV_TIMEOUT_us = 2 * SIFS_us + CTS_us + PHY_RX_START_us + 2 * SLOT_us

SLOTS_EARLY = float(int(CTS_NOTICED_us / SLOT_us))  # the other began first
SLOTS_IN_RTS = float(int(RTS_us / SLOT_us))  # the other begins during the RTS
SLOTS_AFTER_RTS = SLOTS_EARLY - SLOTS_IN_RTS  # before the CTS silences it
SLOTS_MET = 2 * SLOTS_EARLY + 1


class Fate(NamedTuple):
    """What starts of the other station within the slots of a handshake do.

    Args:
        captures: Whether the RTS is received although the other begins with or after it.
        hears_cts: Whether the sender receives the CTS although the other sends.
        kill: Part of data frames that an RTS of the other destroys.
    """

    captures: BoolArray
    hears_cts: BoolArray
    kill: FloatArray


def fatal_slots(fate: Fate, data_us: FloatArray) -> FloatArray:
    """Return in how many slots a start of the other is fatal, by its stage, (relations, 7).

    If the other began first the receiver is busy or silenced, whatever the powers. If it
    begins after the RTS it misses the CTS, and may try again while the data are under way.

    Args:
        fate: What a start does.
        data_us: Duration of the data frames, shape (relations,).
    """
    lost = (~fate.captures).astype(np.float64)[:, None]
    wait_us = BEFORE_CTS_us + ACK_TIMEOUT_us + AIFS_us
    again = np.clip((data_us[:, None] - wait_us + CTS_us) / (2.0 * WINDOWS * SLOT_us), 0.0, 1.0)
    after = np.maximum(~fate.hears_cts[:, None], fate.kill[:, None] * again)
    return np.asarray(SLOTS_EARLY + lost * (1.0 + SLOTS_IN_RTS) + after * SLOTS_AFTER_RTS)


def unmet(slots: FloatArray) -> FloatArray:
    """Return the probability that the other does not begin in a number of slots, by its stage.

    Its attempt probability in a stage is 2 / (W + 1) per slot: Bianchi (2000), Eq. 7, for one
    window.

    >>> [round(p, 3) for p in unmet(np.full(7, 1.0)).tolist()][:2]
    [0.882, 0.939]
    """
    return np.asarray((1.0 - 2.0 / (WINDOWS + 1.0)) ** slots)


def fate_of(scene: Scene, hostile: Hostile, hazard_alone: FloatArray, rts_ratio_dB: float) -> Fate:
    """Return the fate of handshakes of each relation.

    Args:
        scene: The active links.
        hostile: Hidden relations.
        hazard_alone: h(w) of each.
        rts_ratio_dB: Ratio above which control frames survive a collision.
    """
    link, other = hostile.link, hostile.station
    noise_mW = scene.plant.noise_mW
    at_receiver_dB = scene.ratio_dB(scene.at_receiver_mW[other, link] + noise_mW, link)
    own = scene.station[link]
    cts_dBm = scene.receiver_at_station_dBm[link, own]
    at_sender_dB = cts_dBm - dBm_from_mW(scene.at_station_mW[other, own] + noise_mW)
    kill = -np.expm1(-hazard_alone * RTS_us / scene.protected_us[link])
    return Fate(at_receiver_dB >= rts_ratio_dB, at_sender_dB >= rts_ratio_dB, kill)


LARGEST_ON = 0.97


class Unread(NamedTuple):
    """Who may begin between the RTS and the data of a station it senses but did not understand.

    Args:
        spoilt: Whether x, unheard by w, spoils the RTS of u at w, shape (u, w, x).
        exposed: Whether w does not hear the CTS of link l either, shape (links, stations).
        kill: Part of data of l that w destroys, shape (links, stations).
        own_kill: Part of frames of l lost when it begins within an exchange of w; all where
            the receiver decoded the RTS and answers nobody else.
    """

    spoilt: BoolArray
    exposed: FloatArray
    kill: FloatArray
    own_kill: FloatArray


def unread_of(scene: Scene, rts_ratio_dB: float) -> Unread:
    """Return who may begin unawares under RTS/CTS."""
    at_station_mW = scene.at_station_mW
    heard, noise_mW = scene.hears_by_power, scene.plant.noise_mW
    ratio_dB = dBm_from_mW(at_station_mW + 1e-300)[:, :, None] - dBm_from_mW(
        at_station_mW.T + noise_mW
    )
    spoilt = (ratio_dB < rts_ratio_dB) & heard[:, :, None] & ~heard[None, :, :]
    same = np.arange(scene.station_count)
    spoilt[same, :, same] = False
    spoilt[:, same, same] = False
    rows = np.arange(len(scene.links))[:, None]
    data_dB = scene.ratio_dB(scene.at_receiver_mW.T + noise_mW, rows)
    kill = -np.expm1(-hazard(scene.scheme[:, None], data_dB))
    exposed = heard[scene.station] & ~scene.hears_receiver
    decoded = 10.0 ** (scene.settings.preamble_dBm / 10.0) <= scene.at_receiver_mW.T
    return Unread(spoilt, exposed.astype(np.float64), kill, np.where(decoded, 1.0, kill))


def unaware_starts(
    unread: Unread, on: FloatArray, clear: FloatArray, tau: FloatArray
) -> FloatArray:
    """Return how often w begins within an exchange of u that it senses, shape (u, w).

    Counts that end in either of two slots after AIFS end before the data after an unheard CTS.

    Args:
        unread: Who may.
        on: Probability that x is sending while u may count, shape (u, x).
        clear: C of the occupancy.
        tau: Probability of an attempt per decision.
    """
    off = 1.0 - np.minimum(np.maximum(on, 0.0), LARGEST_ON)
    spares = np.where(unread.spoilt, off[:, None, :], 1.0)
    missed = 1.0 - np.multiply.accumulate(spares, axis=2)[:, :, -1]
    waits = 1.0 - tau
    return np.asarray(missed * clear * (1.0 - waits * waits))


def unaware_survival(
    scene: Scene,
    unread: Unread,
    starts: FloatArray,
    answered: FloatArray,
    attempts: FloatArray,
    rate_per_us: FloatArray,
) -> FloatArray:
    """Return what frames of each link survive of unaware starts, others' and their own.

    Args:
        scene: The active links.
        unread: Who may begin unawares.
        starts: How often w begins within an exchange of u, shape (u, w).
        answered: Part of the RTS of each link that are answered.
        attempts: a_l.
        rate_per_us: R_u.
    """
    into = starts[scene.station] * unread.exposed * answered[:, None]  # (l, w)
    survives = row_products(1.0 - into * unread.kill)
    per_us = scene.station_means(attempts, into) * rate_per_us[:, None]
    part = (per_us / rate_per_us).T[scene.station]  # of attempts of l, into exchanges of u
    own_lost = np.minimum(1.0, row_sums(part * unread.own_kill))
    return np.asarray(survives * (1.0 - own_lost))


class Handshakes(NamedTuple):
    """What RTS and CTS change in a scene.

    Args:
        noticed_us: Until when a start of the interferer is fatal to an RTS, shape (relations,).
        by_cts: Whether a relation is one of stations kept apart by CTS only.
        by_cts_survives: What handshakes of these survive, by stage of the other.
        by_cts_missed: How often neither meets the other at all.
        silenced: Whose CTS silence whom, shape (links, stations).
        unread: Who may begin unawares.
    """

    noticed_us: FloatArray
    by_cts: BoolArray
    by_cts_survives: FloatArray
    by_cts_missed: FloatArray
    silenced: FloatArray
    unread: Unread


def handshakes_of(scene: Scene, hostile: Hostile, rts_ratio_dB: float) -> Handshakes:
    """Return what RTS and CTS change.

    Args:
        scene: The active links.
        hostile: Hidden relations.
        rts_ratio_dB: Ratio above which control frames survive a collision.
    """
    fate = fate_of(scene, hostile, hostile.delta[:, 0], rts_ratio_dB)
    return Handshakes(
        np.where(fate.captures, 0.0, CTS_NOTICED_us),
        scene.silenced_by_cts[scene.station[hostile.link], hostile.station],
        unmet(fatal_slots(fate, scene.data_us[hostile.link])),
        unmet(np.full((len(hostile), 1), SLOTS_MET)),
        silenced_share(scene),
        unread_of(scene, rts_ratio_dB),
    )


def silenced_share(scene: Scene) -> FloatArray:
    """Return which links' CTS silence whom though their sender does not, (links, stations)."""
    own = scene.station
    apart = ~scene.senses[own] & (np.arange(scene.station_count)[None, :] != own[:, None])
    return np.asarray(apart & scene.hears_receiver, np.float64)
