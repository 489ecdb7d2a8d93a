"""Handshakes of stations kept apart by CTS alone, against a simulation slot by slot."""

import random

import numpy as np
import pytest
from ncsim_wifi.spatial.acks import control_hazard
from ncsim_wifi.spatial.backoff import WINDOWS
from ncsim_wifi.spatial.handshake import Fate, fatal_slots, unmet

RTS_SLOTS, NOTICED_SLOTS = 3, 5


def fate(captures, hears_cts):
    return Fate(np.array([captures]), np.array([hears_cts]), np.array([0.0]))


@pytest.mark.parametrize(
    ("captures", "hears_cts", "slots"),
    [(False, True, 9), (True, True, 5), (False, False, 11), (True, False, 7)],
)
def test_slots_in_which_a_start_of_the_other_is_fatal(captures, hears_cts, slots):
    assert fatal_slots(fate(captures, hears_cts), np.array([300.0])).tolist() == [[slots] * 7]


def simulated_loss(window):
    """Return how often a station that always starts anew loses to one with a fixed window.

    Counters run in step; a frame lasts three slots and silences the other after five. Who began
    first in four or five slots wins, closer starts destroy both.
    """
    rng = random.Random(1)
    tried = lost = 0
    own, other = rng.randrange(16), rng.randrange(window)
    for _ in range(60_000):
        gap = other - own  # negative: the other began first
        if gap >= -NOTICED_SLOTS:
            tried += 1
            lost += gap <= RTS_SLOTS
        is_over = abs(gap) <= NOTICED_SLOTS
        own, other = (
            rng.randrange(16) if gap >= 0 or is_over else own - other - NOTICED_SLOTS,
            rng.randrange(window) if gap < 0 or is_over else other - own - NOTICED_SLOTS,
        )
    return lost / tried


@pytest.mark.parametrize("stage", [1, 2, 3, 4])
def test_handshakes_meet_as_often_as_counters_do(stage):
    survives = unmet(fatal_slots(fate(captures=False, hears_cts=True), np.array([300.0])))[0]

    assert 1.0 - survives[stage] == pytest.approx(
        simulated_loss(int(WINDOWS[stage])), rel=0.25, abs=0.02
    )


def test_half_of_the_control_frames_survive_somewhat_below_7_dB():
    assert 0.5 < np.exp(-control_hazard(np.array(7.0))) < 0.7
    assert np.exp(-control_hazard(np.array(9.0))) > 0.99
    assert np.exp(-control_hazard(np.array(5.0))) < 0.1
