"""Option schemas: read them, see that they can be composed, fill in their defaults.

Plug-ins write draft-07 within a portable subset: keywords that editors, the composed scenario
schema and this module all understand. References and ids are left out because a schema is
copied into a larger one.
"""

import copy
import importlib.resources
import json
from collections.abc import Iterator, Mapping
from typing import Final, cast

from ncsim_core.errors import PluginError
from ncsim_core.registry.records import OptionsSchema

EMPTY_SCHEMA: Final[OptionsSchema] = {
    "type": "object",
    "properties": {},
    "additionalProperties": False,
}

TYPES: Final = frozenset({"object", "array", "string", "number", "integer", "boolean", "null"})

_NUMBERS = frozenset({"minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum", "multipleOf"})
_COUNTS = frozenset(
    {"minLength", "maxLength", "minItems", "maxItems", "minProperties", "maxProperties"}
)
_TEXTS = frozenset({"title", "description", "pattern", "$comment"})
_LISTS = frozenset({"enum", "examples", "required"})
_SCHEMAS = frozenset({"items", "not", "if", "then", "else", "propertyNames"})
_SCHEMA_LISTS = frozenset({"anyOf", "allOf", "oneOf"})
_ANYTHING = frozenset({"const", "default", "uniqueItems", "type"})

PORTABLE_KEYWORDS: Final = (
    _NUMBERS | _COUNTS | _TEXTS | _LISTS | _SCHEMAS | _SCHEMA_LISTS | _ANYTHING
) | {"properties", "additionalProperties"}


def read_schema(declared: Mapping[str, object] | str | None) -> OptionsSchema:
    """Return a declared schema, read from ``"package:folder/file.json"`` if it is text.

    Raises:
        PluginError: The file is not there, or the schema is outside the portable subset.
    """
    if declared is None:
        return EMPTY_SCHEMA
    schema = _read_file(declared) if isinstance(declared, str) else declared
    fault = schema_fault(schema)
    if fault is not None:
        raise PluginError(f"its schema cannot be used: {fault}")
    return cast("OptionsSchema", schema)


def _read_file(location: str) -> object:
    package, _, path = location.partition(":")
    try:
        text = importlib.resources.files(package).joinpath(path).read_text("utf-8")
        return json.loads(text)
    except (ImportError, OSError, ValueError) as error:
        raise PluginError(f"cannot read the schema {location!r}: {error}") from error


def schema_fault(schema: object) -> str | None:
    """Return why a schema cannot describe options in the portable subset, or ``None``."""
    if not isinstance(schema, Mapping):
        return f"it is {schema!r}, not an object"
    if schema.get("type") != "object" or schema.get("additionalProperties") is not False:
        return 'it needs "type": "object" and "additionalProperties": false'
    return next(_faults(schema, "schema"), None)


def _faults(schema: object, where: str) -> Iterator[str]:
    if isinstance(schema, bool):
        return
    if not isinstance(schema, Mapping):
        yield f"{where} is {schema!r}, not an object"
        return
    for keyword, value in schema.items():
        here = f"{where}.{keyword}"
        if keyword not in PORTABLE_KEYWORDS:
            yield f"{here}: keyword {keyword!r} is outside the portable subset"
        elif not _has_right_form(keyword, value):
            yield f"{here}: {value!r} does not fit"
        else:
            yield from _faults_below(keyword, value, here)


def _faults_below(keyword: str, value: object, where: str) -> Iterator[str]:
    """Yield the faults of the schemas that a keyword holds."""
    if keyword == "properties":
        for name, child in cast("Mapping[str, object]", value).items():
            yield from _faults(child, f"{where}.{name}")
    elif keyword in _SCHEMA_LISTS:
        for index, child in enumerate(cast("list[object]", value)):
            yield from _faults(child, f"{where}[{index}]")
    elif keyword in _SCHEMAS or keyword == "additionalProperties":
        yield from _faults(value, where)


def _has_right_form(keyword: str, value: object) -> bool:
    if keyword == "type":
        names = value if isinstance(value, list) else [value]
        return bool(names) and all(isinstance(each, str) and each in TYPES for each in names)
    if keyword in _NUMBERS or keyword in _COUNTS:
        wanted = (int, float) if keyword in _NUMBERS else int
        return isinstance(value, wanted) and not isinstance(value, bool)
    if keyword in _TEXTS:
        return isinstance(value, str)
    if keyword in _LISTS or keyword in _SCHEMA_LISTS:
        return isinstance(value, list | tuple) and (keyword == "required" or len(value) > 0)
    return keyword != "properties" or isinstance(value, Mapping)


def properties_of(schema: OptionsSchema) -> Mapping[str, Mapping[str, object]]:
    """Return the schema of each property, in declared order."""
    return cast("Mapping[str, Mapping[str, object]]", schema.get("properties", {}))


def with_defaults(schema: OptionsSchema, values: Mapping[str, object]) -> dict[str, object]:
    """Return ``values`` with every missing default filled in, in the order of the schema.

    Objects inside are filled in where they are given.
    """
    filled: dict[str, object] = {}
    for name, child in properties_of(schema).items():
        if name in values:
            value = values[name]
            is_object = isinstance(value, Mapping) and "properties" in child
            filled[name] = (
                with_defaults(child, cast("dict[str, object]", value)) if is_object else value
            )
        elif "default" in child:
            filled[name] = copy.deepcopy(child["default"])
    return filled | {name: value for name, value in values.items() if name not in filled}
