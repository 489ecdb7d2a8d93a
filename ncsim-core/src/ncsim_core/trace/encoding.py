"""Records as lines of JSON, many in one call: docs/decisions/0008-trace-writing.md.

The classes are the frequent records of ``trace/fields.py``, field by field, in the form that costs
least to make and to encode.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from numbers import Integral
from typing import Final

from msgspec import Raw, Struct
from msgspec.json import Encoder

to_json: Final[Callable[[object], str]] = json.JSONEncoder(
    separators=(",", ":"), ensure_ascii=False, allow_nan=False
).encode
"""Says anything that JSON can say and nothing else; a tenth as fast."""


class TaskRecord(Struct, gc=False):
    """``ready``, ``start`` or ``end``."""

    t: int
    k: str
    i: int
    n: int


class StartRecord(Struct, gc=False):
    """``xstart``."""

    t: int
    k: str
    x: int
    route: Sequence[int]
    size: float


class RateRecord(Struct, gc=False):
    """``recalc``."""

    t: int
    k: str
    by: tuple[str, int]
    x: Sequence[int]
    r: Sequence[float]
    l: Sequence[int]  # noqa: E741 - the name that the format gives it
    nc: Sequence[int]
    nh: Sequence[int]
    fh: Sequence[float]
    f: Sequence[int]


class EndRecord(Struct, gc=False):
    """``xend``."""

    t: int
    k: str
    x: int


class NoteRecord(Struct, gc=False):
    """``note``; what plug-ins say is encoded already."""

    t: int
    k: str
    ns: Raw
    data: Raw


def lines_of(records: Sequence[Struct]) -> bytes:
    """Return a line for each record."""
    return _ENCODER.encode_lines(records)


def line_of(document: Mapping[str, object]) -> bytes:
    """Return a document without infinities as a line."""
    try:
        return _ENCODER.encode(document) + b"\n"
    except UnicodeEncodeError:  # half of a surrogate pair
        return json_bytes(document) + b"\n"


def json_bytes(document: object) -> bytes:
    """Return anything that JSON can say.

    Raises:
        ValueError: It holds an infinity or what is no number.
        TypeError: It holds what JSON does not know.
    """
    return to_json(document).encode("utf-8", "backslashreplace")


def _plain_number(number: object) -> float:
    """Return what a plug-in's own type of number stands for, numpy's for example."""
    if isinstance(number, Integral):
        return int(number)
    return float(number)  # type: ignore[arg-type]  # else it says so


_ENCODER: Final = Encoder(enc_hook=_plain_number)
