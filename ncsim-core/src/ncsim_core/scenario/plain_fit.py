"""Says in microseconds whether data plainly fits a schema.

A "yes" is certain, and means that all numbers are finite; a "no" only means that jsonschema has to
be asked, which knows every keyword and can explain. A good scenario of any size is thus accepted
without importing jsonschema.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from math import isfinite
from typing import Any, TypeAlias

from ncsim_core.scenario.faults import Data

Check: TypeAlias = Callable[[Any], bool]
"""Whether a value certainly fits."""

ANNOTATIONS = frozenset(
    {"$schema", "$comment", "title", "description", "default", "examples", "definitions"}
)

_TYPES: Mapping[str, tuple[type, ...]] = {
    "object": (dict,),
    "array": (list,),
    "string": (str,),
    "number": (int, float),
    "integer": (int,),
    "boolean": (bool,),
    "null": (type(None),),
}


def plain_fit(schema: Mapping[str, Any], root: Mapping[str, Any] | None = None) -> Check:
    """Return a check for ``schema``; references are looked up in ``root``."""
    root = schema if root is None else root
    checks = [
        _keyword_check(keyword, value, schema, root)
        for keyword, value in schema.items()
        if keyword not in ANNOTATIONS and keyword not in {"then", "else"}
    ]
    return _every(checks)


def _every(checks: Sequence[Check]) -> Check:
    """Return a check that all of some checks pass; a loop, for a generator takes twice as long."""
    if len(checks) == 1:
        return checks[0]

    def check_all(value: Data) -> bool:
        for check in checks:  # noqa: SIM110 - a generator takes twice as long
            if not check(value):
                return False
        return True

    return check_all


def _keyword_check(
    keyword: str, value: Data, schema: Mapping[str, Any], root: Mapping[str, Any]
) -> Check:
    if keyword in _SCALAR_CHECKS:
        return _SCALAR_CHECKS[keyword](value)
    if keyword in {"properties", "items", "anyOf", "allOf", "if", "$ref"}:
        return _NESTED_CHECKS[keyword](value, schema, root)
    if keyword == "additionalProperties" and value is False:
        known = frozenset(schema.get("properties", ()))
        return lambda data: not isinstance(data, dict) or data.keys() <= known
    return lambda _: False


def _type_check(names: str | list[str]) -> Check:
    listed = [names] if isinstance(names, str) else names
    accepted = {exact for name in listed for exact in _TYPES[name]}
    return lambda data: type(data) in accepted and (type(data) is not float or isfinite(data))


def _enum_check(choices: list[Any]) -> Check:
    exact = [(type(choice), choice) for choice in choices]
    return lambda data: (type(data), data) in exact


def _pattern_check(pattern: str) -> Check:
    search = re.compile(pattern).search
    return lambda data: not isinstance(data, str) or search(data) is not None


def _required_check(names: list[str]) -> Check:
    needed = frozenset(names)
    return lambda data: not isinstance(data, dict) or data.keys() >= needed


def _bound_check(holds: Callable[[Any, Any], bool]) -> Callable[[Any], Check]:
    def check_for(bound: Data) -> Check:
        return lambda data: type(data) not in _TYPES["number"] or holds(data, bound)

    return check_for


def _length_check(
    kind: type[str] | type[list[Data]], holds: Callable[[int, int], bool]
) -> Callable[[int], Check]:
    def check_for(bound: int) -> Check:
        return lambda data: not isinstance(data, kind) or holds(len(data), bound)

    return check_for


_SCALAR_CHECKS: Mapping[str, Callable[[Any], Check]] = {
    "type": _type_check,
    "enum": _enum_check,
    "const": lambda choice: _enum_check([choice]),
    "pattern": _pattern_check,
    "required": _required_check,
    "minimum": _bound_check(lambda data, bound: data >= bound),
    "maximum": _bound_check(lambda data, bound: data <= bound),
    "exclusiveMinimum": _bound_check(lambda data, bound: data > bound),
    "exclusiveMaximum": _bound_check(lambda data, bound: data < bound),
    "minLength": _length_check(str, lambda length, bound: length >= bound),
    "maxLength": _length_check(str, lambda length, bound: length <= bound),
    "minItems": _length_check(list, lambda length, bound: length >= bound),
    "maxItems": _length_check(list, lambda length, bound: length <= bound),
}


def _properties_check(
    properties: Mapping[str, Any], _schema: Mapping[str, Any], root: Mapping[str, Any]
) -> Check:
    checks = {name: plain_fit(child, root) for name, child in properties.items()}

    def check(data: Data) -> bool:
        if not isinstance(data, dict):
            return True
        for key, value in data.items():  # noqa: SIM110 - as in _every
            if key in checks and not checks[key](value):
                return False
        return True

    return check


def _items_check(items: Data, _schema: Mapping[str, Any], root: Mapping[str, Any]) -> Check:
    if not isinstance(items, Mapping):
        return lambda _: False
    check = plain_fit(items, root)
    return lambda data: not isinstance(data, list) or all(map(check, data))


def _any_of_check(choices: Data, _schema: Mapping[str, Any], root: Mapping[str, Any]) -> Check:
    checks = [plain_fit(choice, root) for choice in choices]
    return lambda data: any(check(data) for check in checks)


def _all_of_check(parts: Data, _schema: Mapping[str, Any], root: Mapping[str, Any]) -> Check:
    return _every([plain_fit(part, root) for part in parts])


def _if_check(condition: Data, schema: Mapping[str, Any], root: Mapping[str, Any]) -> Check:
    """Return a check of both outcomes: without certainty about ``if``, ``then`` must hold too.

    ``if`` of a composed schema tests one ``type`` name, where a plain misfit is a true misfit.
    """
    if not _is_exact(condition):
        return lambda _: False
    when = plain_fit(condition, root)
    then = plain_fit(schema.get("then", {}), root)
    otherwise = plain_fit(schema.get("else", {}), root)
    return lambda data: then(data) if when(data) else otherwise(data)


def _is_exact(condition: Data) -> bool:
    """Return whether a plain "no" to this schema is a certain one: only names in enums."""
    if not isinstance(condition, Mapping) or not condition.keys() <= {"properties", "required"}:
        return False
    properties = condition.get("properties", {})
    return all(
        child.keys() == {"enum"} and all(isinstance(name, str) for name in child["enum"])
        for child in properties.values()
    )


def _ref_check(reference: str, _schema: Mapping[str, Any], root: Mapping[str, Any]) -> Check:
    found: Any = root
    for step in reference.removeprefix("#/").split("/"):
        found = found[step]
    return plain_fit(found, root)


_NESTED_CHECKS: Mapping[str, Callable[[Any, Mapping[str, Any], Mapping[str, Any]], Check]] = {
    "properties": _properties_check,
    "items": _items_check,
    "anyOf": _any_of_check,
    "allOf": _all_of_check,
    "if": _if_check,
    "$ref": _ref_check,
}
