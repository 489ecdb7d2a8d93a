"""The order in which SAGA walks its sets, under every hash seed.

SAGA keeps tasks, nodes and edges in frozensets and breaks ties by the order in which these are
walked. That order follows from the hashes of names and so from ``PYTHONHASHSEED``. The published
results are those of seed 0, which makes the key of CPython's string hash zero. This module
computes these hashes, so that ncsim can give SAGA elements that always carry them.

A set's order depends on the hashes and on the history of insertions; here every set is grown
one element at a time in file order, as pydantic grows SAGA's.

Source: SPEC 22; SipHash-1-3 as in CPython's ``Python/pyhash.c`` (3.11 and later), the hash of a
tuple as in ``Objects/tupleobject.c`` (3.8 and later).
"""

from collections.abc import Iterable, Sequence
from functools import lru_cache

from typing_extensions import override

_WORD = (1 << 64) - 1
_SIP_START = (0x736F6D6570736575, 0x646F72616E646F6D, 0x6C7967656E657261, 0x7465646279746573)
_XXH_PRIME_1 = 11400714785074694791
_XXH_PRIME_2 = 14029467366897019727
_XXH_PRIME_5 = 2870177450012600261
_PAIR_LENGTH_MIX = 2 ^ _XXH_PRIME_5 ^ 3527539
_HASH_INSTEAD_OF_MINUS_ONE = 1546275796

MAX_REMEMBERED_NAMES = 1 << 17


@lru_cache(maxsize=MAX_REMEMBERED_NAMES)
def name_hash(name: str) -> int:
    """Return ``hash(name)`` of a CPython run with ``PYTHONHASHSEED=0``.

    >>> name_hash("n0")
    8008715040400828473
    """
    if not name:
        return 0
    return _signed(_siphash13(_as_in_memory(name)))


def pair_hash(first: str, second: str) -> int:
    """Return ``hash((first, second))`` of a CPython run with ``PYTHONHASHSEED=0``."""
    mixed = (_XXH_PRIME_5 + (name_hash(first) & _WORD) * _XXH_PRIME_2) & _WORD
    mixed = ((mixed << 31 | mixed >> 33) * _XXH_PRIME_1) & _WORD
    mixed = (mixed + (name_hash(second) & _WORD) * _XXH_PRIME_2) & _WORD
    mixed = ((mixed << 31 | mixed >> 33) * _XXH_PRIME_1) & _WORD
    mixed = (mixed + _PAIR_LENGTH_MIX) & _WORD
    return _HASH_INSTEAD_OF_MINUS_ONE if mixed == _WORD else _signed(mixed)


def all_pair_hashes(names: Sequence[str]) -> list[int]:
    """Return ``pair_hash(first, second)`` for all ordered pairs, row by row.

    In numpy, for the many virtual links of a large network; unsigned arithmetic wraps around as
    CPython's does.
    """
    import numpy as np

    lanes = np.array([name_hash(name) & _WORD for name in names], np.uint64)
    lanes *= np.uint64(_XXH_PRIME_2)
    left, right, prime = np.uint64(31), np.uint64(33), np.uint64(_XXH_PRIME_1)
    mixed = lanes + np.uint64(_XXH_PRIME_5)
    mixed = (mixed << left | mixed >> right) * prime
    mixed = (mixed[:, None] + lanes[None, :]).ravel()
    mixed = (mixed << left | mixed >> right) * prime + np.uint64(_PAIR_LENGTH_MIX & _WORD)
    mixed[mixed == np.uint64(_WORD)] = np.uint64(_HASH_INSTEAD_OF_MINUS_ONE)
    values: list[int] = mixed.view(np.int64).tolist()
    return values


def walking_order(hashes: Iterable[int]) -> list[int]:
    """Return the positions of elements in the order in which a set of them is walked.

    Args:
        hashes: The hash of each element, in the order of insertion; elements are distinct.
    """
    grown: set[_Placeholder] = set()
    for position, value in enumerate(hashes):
        grown.add(_Placeholder(value, position))
    return [placeholder.position for placeholder in grown]


class _Placeholder:
    """Stands for a set element with a given hash."""

    __slots__ = ("position", "value")

    def __init__(self, value: int, position: int) -> None:
        self.value = value
        self.position = position

    @override
    def __hash__(self) -> int:
        return self.value


def _as_in_memory(name: str) -> bytes:
    """Return the bytes that CPython keeps for a string: 1, 2 or 4 per character."""
    widest = max(name)
    if widest <= "\xff":
        return name.encode("latin-1")
    encoding = "utf-16-le" if widest <= "\uffff" else "utf-32-le"
    return name.encode(encoding, "surrogatepass")


def _siphash13(data: bytes) -> int:
    """Return SipHash with 1 compression and 3 finalisation rounds and a zero key."""
    state = _SIP_START
    whole = len(data) - len(data) % 8
    tail = int.from_bytes(data[whole:], "little") | (len(data) & 0xFF) << 56
    words = [int.from_bytes(data[at : at + 8], "little") for at in range(0, whole, 8)]
    for word in (*words, tail):
        v0, v1, v2, v3 = state
        v0, v1, v2, v3 = _sip_round(v0, v1, v2, v3 ^ word)
        state = (v0 ^ word, v1, v2, v3)
    v0, v1, v2, v3 = state
    v2 ^= 0xFF
    for _ in range(3):
        v0, v1, v2, v3 = _sip_round(v0, v1, v2, v3)
    return v0 ^ v1 ^ v2 ^ v3


def _sip_round(v0: int, v1: int, v2: int, v3: int) -> tuple[int, int, int, int]:
    v0 = (v0 + v1) & _WORD
    v2 = (v2 + v3) & _WORD
    v1 = _rotated(v1, 13) ^ v0
    v3 = _rotated(v3, 16) ^ v2
    v2 = (v2 + v1) & _WORD
    v0 = (_rotated(v0, 32) + v3) & _WORD
    v1 = _rotated(v1, 17) ^ v2
    v3 = _rotated(v3, 21) ^ v0
    return v0, v1, _rotated(v2, 32), v3


def _rotated(value: int, bits: int) -> int:
    return ((value << bits) | (value >> (64 - bits))) & _WORD


def _signed(value: int) -> int:
    """Return 64 bits as CPython's ``Py_hash_t``, which is never -1."""
    signed = value - (1 << 64) if value >> 63 else value
    return -2 if signed == -1 else signed
