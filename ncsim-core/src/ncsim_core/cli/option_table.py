"""An options schema as a table for people."""

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import cast

from ncsim_core.cli.tables import aligned
from ncsim_core.registry.option_schemas import properties_of

HEADINGS = ("option", "type", "default", "bounds", "description")

_BOUNDS = {
    "minimum": ">= {}",
    "exclusiveMinimum": "> {}",
    "maximum": "<= {}",
    "exclusiveMaximum": "< {}",
    "minItems": "at least {} items",
    "maxItems": "at most {} items",
    "pattern": "like {}",
}


def option_table(schema: Mapping[str, object]) -> str:
    """Return a table of all options with type, default, bounds and description.

    >>> print(option_table({"properties": {}}))
    no options
    """
    rows = list(_rows(schema, ""))
    if not rows:
        return "no options"
    return aligned(rows, HEADINGS)


def _rows(schema: Mapping[str, object], prefix: str) -> Iterator[Sequence[str]]:
    """Yield one row per option, those of objects inside under ``outer.inner``."""
    required = cast("Sequence[str]", schema.get("required", ()))
    for name, child in properties_of(schema).items():
        default = json.dumps(child["default"]) if "default" in child else "-"
        description = str(child.get("description", ""))
        yield (
            f"{prefix}{name}",
            _type(child),
            "required" if name in required else default,
            _bounds(child),
            description,
        )
        yield from _rows(child, f"{prefix}{name}.")


def _type(schema: Mapping[str, object]) -> str:
    if "enum" in schema:
        return " | ".join(str(each) for each in cast("list[object]", schema["enum"]))
    branches = schema.get("anyOf", schema.get("oneOf"))
    if branches is not None:
        return " | ".join(_type(each) for each in cast("list[Mapping[str, object]]", branches))
    types = schema.get("type", "any")
    return " | ".join(types) if isinstance(types, list) else str(types)


def _bounds(schema: Mapping[str, object]) -> str:
    bounds = [text.format(schema[key]) for key, text in _BOUNDS.items() if key in schema]
    return ", ".join(bounds) or "-"
