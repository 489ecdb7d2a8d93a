"""When compiled functions are used."""

import sys

import pytest
from ncsim_core import acceleration
from ncsim_core.acceleration import Payback, START_us
from ncsim_core.memory import limited_memory

COMPILE_us = 5_000_000


@pytest.fixture
def machine(monkeypatch, tmp_path):
    """Return a function that says what there is, and makes the payback of a new process."""
    monkeypatch.setattr(acceleration, "_has_numba", lambda: True)
    monkeypatch.setattr(acceleration, "numba_starts", lambda: True)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)

    def payback(pure="", *, is_loaded=False, are_kept=False):
        monkeypatch.setenv("NCSIM_PURE", pure)
        if is_loaded:
            monkeypatch.setitem(sys.modules, "numba", acceleration)
        else:
            monkeypatch.delitem(sys.modules, "numba", raising=False)
        if are_kept:
            (tmp_path / "__pycache__").mkdir()
            (tmp_path / "__pycache__" / "loop.advance-1.py311.nbi").touch()
        return Payback(tmp_path, COMPILE_us)

    return payback


@pytest.mark.parametrize(
    ("there_is", "price_us"),
    [
        ({}, START_us + COMPILE_us),
        ({"is_loaded": True}, COMPILE_us),
        ({"are_kept": True}, START_us),
        ({"is_loaded": True, "are_kept": True}, 0),
        ({"pure": "0"}, 0),
    ],
)
def test_what_has_to_be_saved_is_what_is_not_there_yet(there_is, price_us, machine):
    payback = machine(**there_is)

    if price_us:
        assert not payback.is_reached(price_us - 1)
    assert payback.is_reached(min(1, price_us))


def test_savings_of_many_short_runs_add_up(machine):
    payback = machine(are_kept=True)

    assert [payback.is_reached(START_us // 4) for _ in range(4)] == [False, False, False, True]


def test_nothing_is_compiled_if_somebody_says_so(machine):
    assert not machine("1", is_loaded=True, are_kept=True).is_reached(10**9)


def test_nothing_is_compiled_where_memory_is_limited(machine):
    payback = machine("0")

    with limited_memory(1000.0):
        assert not payback.is_reached(10**9)
    assert payback.is_reached(0)


def test_a_folder_of_the_users_is_taken_to_hold_what_is_kept(machine, monkeypatch):
    payback = machine(is_loaded=True)
    monkeypatch.setenv("NUMBA_CACHE_DIR", "somewhere")

    assert payback.is_reached(0)
