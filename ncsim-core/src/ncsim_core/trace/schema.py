"""The JSON Schema of one line of a trace, made of the same table that the reader checks by."""

from collections.abc import Iterable, Mapping

from ncsim_core.trace.fields import HEADER_FIELDS, RECORDS, Field
from ncsim_core.trace.records import FORMAT, TIME_UNIT

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def trace_schema() -> dict[str, object]:
    """Return the JSON Schema that every line of a trace obeys.

    Kinds and fields that a later minor version brings are allowed: readers ignore them.
    """
    return {
        "$schema": DIALECT,
        "title": "One line of an ncsim trace, version 1",
        "description": (
            "Line 1 is the header; then one record per event in order of time; the last is done. "
            "The sequence number of a record is its line number. Numbers of tasks and edges "
            "are given by inject records, those of nodes and links by the header's tables."
        ),
        "oneOf": [
            {"$ref": "#/$defs/header"},
            *({"$ref": f"#/$defs/{kind}"} for kind in RECORDS),
            {"$ref": "#/$defs/later"},
        ],
        "$defs": {
            "header": _header_schema(),
            **{kind: _record_schema(kind, spec.fields) for kind, spec in RECORDS.items()},
            "later": _later_schema(),
        },
    }


def _header_schema() -> dict[str, object]:
    properties = _properties(HEADER_FIELDS)
    properties["format"] |= {"const": FORMAT}
    properties["version"] |= {"pattern": r"^1\.[0-9]+$"}
    properties["time_unit"] |= {"const": TIME_UNIT}
    properties["level"] |= {"enum": ["full", "coarse"]}
    return _object_schema(properties)


def _record_schema(kind: str, fields: Iterable[Field]) -> dict[str, object]:
    return _object_schema({"t": _TIME, "k": {"const": kind}, **_properties(fields)})


def _later_schema() -> dict[str, object]:
    return {
        "type": "object",
        "description": "A kind that a later minor version brings.",
        "properties": {"t": _TIME, "k": {"type": "string", "not": {"enum": list(RECORDS)}}},
        "required": ["t", "k"],
    }


_TIME = {"type": "integer", "minimum": 0, "description": "time in microseconds"}


def _properties(fields: Iterable[Field]) -> dict[str, dict[str, object]]:
    return {each.key: {"description": each.meaning, **each.shape.schema} for each in fields}


def _object_schema(properties: Mapping[str, object]) -> dict[str, object]:
    return {"type": "object", "properties": dict(properties), "required": list(properties)}
