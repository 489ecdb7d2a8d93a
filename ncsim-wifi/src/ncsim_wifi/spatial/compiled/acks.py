"""Frames lost to acknowledgements, and acknowledgements lost, link by link.

Source: MODEL 3.9; see ``ncsim_wifi.spatial.acks``.
"""

import math

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.acks import LEAST_PART, MOST_ANSWERS, Overlapped
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.compiled.collisions import multiply
from ncsim_wifi.spatial.compiled.state import State, Traffic
from ncsim_wifi.spatial.compiled.tables import Air, Constants, Records
from ncsim_wifi.spatial.losses import HiddenLoss


@inlined
def lose_answers(
    constants: Constants,
    air: Air,
    state: State,
    traffic: Traffic,
    data: tuple[Overlapped, FloatArray],
    base: FloatArray,
) -> FloatArray:
    """Multiply by what acknowledgements leave; return how many of their own senders receive.

    Args:
        constants: Settings.
        air: Links and stations.
        state: Attempts and losses.
        traffic: What stations do.
        data: What becomes of overlapped frames, and what of each link a station does not destroy.
        base: What is multiplied.
    """
    sending = traffic.sending
    if constants.rts_cts:
        sending = _not_stopped(air, state, sending)
    heard, sent = np.empty(len(base)), np.empty(len(base))
    _fill_heard(air, sending, data[1], heard)
    left = heard.copy()
    for link in range(len(base)):
        own, rate_per_us = state.links[link], traffic.rate_per_us[air.links[link].station]
        sent[link] = rate_per_us * own.attempts * (1.0 - own.loss)
        if constants.rts_cts:
            sent[link] = sent[link] * 2.0
    _spare_acks(air.acks, data[0], sent, left)
    multiply(base, left)
    return heard


@inlined
def _not_stopped(air: Air, state: State, sending: FloatArray) -> FloatArray:
    """Return how likely stations send although a CTS may have stopped them."""
    count = len(sending)
    stopped = np.zeros((count, count))
    for link in range(len(air.links)):
        part = state.links[link].attempts * state.links[link].answered
        for w in range(count):
            meeting = air.meetings[link, w]
            stopped[air.links[link].station, w] += part * meeting.silenced
    left = np.empty((count, count))
    for u in range(count):
        for w in range(count):
            left[u, w] = sending[u, w] * (1.0 - stopped[w, u])
    return left


@inlined
def fill_spared(
    constants: Constants, relations: Records, kill: FloatArray, spared: FloatArray
) -> None:
    """Fill what stations leave of frames that they overlap."""
    for at in range(len(kill)):
        own = relations[at]
        lost = own.alone_kill if own.by_cts_only and constants.rts_cts else kill[at]
        spared[own.link, own.station] = 1.0 - lost


@inlined
def _fill_heard(air: Air, sending: FloatArray, spared: FloatArray, heard: FloatArray) -> None:
    """Fill the part of acknowledgements that senders receive.

    Args:
        air: Links and stations.
        sending: How likely w is sending while u may count, shape (stations u, stations w).
        spared: Part of the data of each link that a station does not destroy.
        heard: What is filled.
    """
    for link in range(len(heard)):
        product, u = 1.0, air.links[link].station
        for w in range(len(sending)):
            part = min(max(sending[u, w] * spared[link, w], 0.0), 1.0)
            product = product * (1.0 - air.meetings[link, w].deaf_to_ack * part)
        heard[link] = product


@inlined
def overlapped(constants: Constants, relations: Records, loss: HiddenLoss) -> Overlapped:
    """Return what becomes of frames that relations may overlap; the last is for want of one."""
    count = len(relations)
    hit, survives, left = np.ones((3, count + 1))
    prolongs = np.zeros(count + 1, np.bool_)
    for at in range(count):
        own = relations[at]
        hit[at] = loss.alone[at, 0] * loss.hit[at, 0]
        survives[at] = loss.alone[at, 0] * loss.survives[at, 0]
        for k in range(1, STAGES):
            hit[at] = hit[at] + loss.alone[at, k] * loss.hit[at, k]
            survives[at] = survives[at] + loss.alone[at, k] * loss.survives[at, k]
        if constants.rts_cts:
            left[at] = 1.0 - (own.alone_kill if own.by_cts_only else loss.kill[at])
        else:
            prolongs[at] = loss.kill[at] >= constants.ack_extension_kill
    return Overlapped(hit, survives, prolongs, left)


@inlined
def none_overlapped() -> Overlapped:
    """Return the same without relations."""
    every = np.ones(1)
    return Overlapped(every, every, np.zeros(1, np.bool_), every)


@inlined
def _spare_acks(acks: Records, met: Overlapped, sent: FloatArray, survives: FloatArray) -> None:
    """Multiply by what acknowledgements of hidden links leave of frames.

    Args:
        acks: Who suffers from whose.
        met: What becomes of overlapped frames, by hidden relation.
        sent: Acknowledgements per time of each link.
        survives: What is multiplied.
    """
    product = np.ones(len(survives))
    for ack in acks:
        data, rate_per_us = ack.relation, sent[ack.two]
        if met.prolongs[data]:
            sent_part = min(1.0, _of_survivors(met, ack.back) / max(met.hit[ack.back], LEAST_PART))
            number = rate_per_us * ack.later_us / max(met.hit[data], LEAST_PART) * sent_part
            among = _of_survivors(met, data)
            left = 1.0 - among + among * _ack_survival(min(number, MOST_ANSWERS), ack.kill)
        else:
            left = _ack_survival(rate_per_us * ack.window_us, ack.kill * met.left[data])
        product[ack.one] *= max(1e-12, left)
    multiply(survives, product)


@inlined
def _of_survivors(met: Overlapped, at: int) -> float:
    """Return the part of frames surviving a relation that it has overlapped."""
    hit, survives = max(met.hit[at], LEAST_PART), max(met.survives[at], LEAST_PART)
    part: float = max(0.0, survives - (1.0 - hit)) / survives
    return part


@inlined
def _ack_survival(expected: float, kill: float) -> float:
    """Return f, what a frame survives if a number of acknowledgements falls into it."""
    whole = math.floor(expected)
    kill = min(kill, 1.0)
    spared = 1.0 - (expected - whole) * kill
    for _ in range(int(whole)):
        spared = spared * (1.0 - kill)
    return spared
