"""Hashes and set orders against a real interpreter with hash seed 0."""

import json
import os
import subprocess
import sys

import pytest
from ncsim_saga import hash_order
from ncsim_saga.hash_order import all_pair_hashes, name_hash, pair_hash, walking_order

SIZES = [0, 1, 4, 5, 20, 21, 100, 333, 2000]
WALKS_OF_SEED_ZERO = """
import json, sys
for size in json.loads(sys.argv[1]):
    grown = set()
    for number in range(size):
        grown.add(f"T{number}")
    print(json.dumps([int(name[1:]) for name in grown]))
"""


def test_walking_order_is_that_of_a_set_grown_one_by_one():
    done = subprocess.run(
        [sys.executable, "-c", WALKS_OF_SEED_ZERO, json.dumps(SIZES)],
        env=os.environ | {"PYTHONHASHSEED": "0"},
        capture_output=True,
        text=True,
        check=True,
    )
    for size, line in zip(SIZES, done.stdout.splitlines(), strict=True):
        hashes = [name_hash(f"T{number}") for number in range(size)]

        assert walking_order(hashes) == json.loads(line)


def test_hash_of_the_empty_name_is_zero():
    assert name_hash("") == 0


def test_names_longer_than_a_length_byte_are_hashed_whole():
    assert name_hash("x" * 300) != name_hash("x" * 44)


def test_a_name_with_a_lone_surrogate_has_a_hash():
    assert isinstance(name_hash("\ud800"), int)


@pytest.mark.parametrize(("bits", "value"), [(0, 0), (2**64 - 1, -2), (2**63, -(2**63))])
def test_hashes_are_signed_and_never_minus_one(bits, value):
    assert hash_order._signed(bits) == value


def test_all_pairs_at_once_equal_one_by_one():
    names = [f"n{number}" for number in range(30)]

    assert all_pair_hashes(names) == [pair_hash(a, b) for a in names for b in names]


def test_elements_of_equal_hash_stay_apart():
    assert sorted(walking_order([7, 7, 7])) == [0, 1, 2]


def test_numpy_is_not_needed_for_single_hashes(monkeypatch):
    monkeypatch.setitem(sys.modules, "numpy", None)

    assert pair_hash("a", "b") != pair_hash("b", "a")
