"""The shapes a field of a trace record can have: one table for checking, schema and docs."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from ncsim_core.units import MAX_QUANTITY

MAX_SHOWN_CHARACTERS: Final = 60
MAX_COUNT: Final = 2**63 - 1


@dataclass(frozen=True)
class Shape:
    """What a value must look like.

    Args:
        says: The shape in words, for messages.
        accepts: Whether a value read from JSON has it.
        schema: The same as JSON Schema.
    """

    says: str
    accepts: Callable[[object], bool]
    schema: Mapping[str, object]


def shown(value: object) -> str:
    """Return a value as a message shows it: on one line, cut when long."""
    text = value.decode("utf-8", "replace").strip() if isinstance(value, bytes) else repr(value)
    return text if len(text) <= MAX_SHOWN_CHARACTERS else text[:MAX_SHOWN_CHARACTERS] + "..."


def is_count(value: object) -> bool:
    """Return whether a value is a whole number of 0 or more, of 63 bits (and no boolean)."""
    return type(value) is int and 0 <= value <= MAX_COUNT


def is_quantity(value: object) -> bool:
    """Return whether a value is a number from 0 to ``MAX_QUANTITY`` (and no boolean)."""
    return (type(value) is float or type(value) is int) and 0 <= value <= MAX_QUANTITY


def is_number(value: object) -> bool:
    """Return whether a value is a finite number (and no boolean)."""
    return (type(value) is float or type(value) is int) and _is_finite(value)


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number beyond every float
        return False


def _is_text(value: object) -> bool:
    return type(value) is str


def _list_of(accepts: Callable[[object], bool]) -> Callable[[object], bool]:
    return lambda value: isinstance(value, list) and all(map(accepts, value))


def _row_of(*columns: Callable[[object], bool]) -> Callable[[object], bool]:
    def accepts(value: object) -> bool:
        return (
            isinstance(value, list)
            and len(value) == len(columns)
            and all(column(entry) for column, entry in zip(columns, value, strict=True))
        )

    return accepts


def _or_null(accepts: Callable[[object], bool]) -> Callable[[object], bool]:
    return lambda value: value is None or accepts(value)


def _is_cause(value: object) -> bool:
    return _row_of(lambda change: change in ("s", "e"), is_count)(value)


_COUNT_SCHEMA: Final = {"type": "integer", "minimum": 0, "maximum": MAX_COUNT}
_QUANTITY_SCHEMA: Final = {"type": "number", "minimum": 0, "maximum": MAX_QUANTITY}
_TEXT_SCHEMA: Final = {"type": "string"}
_POSITION_SCHEMA: Final = {"type": ["number", "null"]}


def _row_schema(*columns: Mapping[str, object]) -> Mapping[str, object]:
    return {
        "type": "array",
        "prefixItems": list(columns),
        "minItems": len(columns),
        "maxItems": len(columns),
    }


def _rows_schema(*columns: Mapping[str, object]) -> Mapping[str, object]:
    return {"type": "array", "items": _row_schema(*columns)}


COUNT: Final = Shape("a whole number, 0 or more", is_count, _COUNT_SCHEMA)
COUNT_OR_NULL: Final = Shape(
    "a whole number, 0 or more, or null",
    _or_null(is_count),
    {"type": ["integer", "null"], "minimum": 0, "maximum": MAX_COUNT},
)
QUANTITY: Final = Shape(f"a number from 0 to {MAX_QUANTITY:g}", is_quantity, _QUANTITY_SCHEMA)
TEXT: Final = Shape("a text", _is_text, _TEXT_SCHEMA)
ANYTHING: Final = Shape("any value", lambda _: True, {})
COUNTS: Final = Shape(
    "a list of whole numbers, 0 or more",
    _list_of(is_count),
    {"type": "array", "items": _COUNT_SCHEMA},
)
QUANTITIES: Final = Shape(
    f"a list of numbers from 0 to {MAX_QUANTITY:g}",
    _list_of(is_quantity),
    {"type": "array", "items": _QUANTITY_SCHEMA},
)
CAUSE: Final = Shape(
    'a pair of "s" (start) or "e" (end) and a transfer number',
    _is_cause,
    _row_schema({"enum": ["s", "e"]}, _COUNT_SCHEMA),
)
COUNT_BY_TEXT: Final = Shape(
    "an object with a whole number under each key",
    lambda value: isinstance(value, dict) and all(map(is_count, value.values())),
    {"type": "object", "additionalProperties": _COUNT_SCHEMA},
)
OBJECT: Final = Shape("an object", lambda value: isinstance(value, dict), {"type": "object"})
TASK_ROWS: Final = Shape(
    "a list of [id, cost]",
    _list_of(_row_of(_is_text, is_quantity)),
    _rows_schema(_TEXT_SCHEMA, _QUANTITY_SCHEMA),
)
EDGE_ROWS: Final = Shape(
    "a list of [producing task, waiting task, size_MB]",
    _list_of(_row_of(is_count, is_count, is_quantity)),
    _rows_schema(_COUNT_SCHEMA, _COUNT_SCHEMA, _QUANTITY_SCHEMA),
)
NODE_ROWS: Final = Shape(
    "a list of [id, capacity, x_m, y_m]",
    _list_of(_row_of(_is_text, is_quantity, _or_null(is_number), _or_null(is_number))),
    _rows_schema(_TEXT_SCHEMA, _QUANTITY_SCHEMA, _POSITION_SCHEMA, _POSITION_SCHEMA),
)
LINK_ROWS: Final = Shape(
    "a list of [id, source, target, bandwidth_MBps, latency_s, medium]",
    _list_of(_row_of(_is_text, is_count, is_count, is_quantity, is_quantity, _is_text)),
    _rows_schema(
        _TEXT_SCHEMA,
        _COUNT_SCHEMA,
        _COUNT_SCHEMA,
        _QUANTITY_SCHEMA,
        _QUANTITY_SCHEMA,
        _TEXT_SCHEMA,
    ),
)
