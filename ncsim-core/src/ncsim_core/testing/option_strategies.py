"""Options and config sections, drawn from the schemas that plug-ins publish."""

from collections.abc import Mapping, Sequence
from typing import cast

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from ncsim_core.plugins import Component
from ncsim_core.registry import OptionsSchema, Registry, get_registry
from ncsim_core.registry.option_schemas import properties_of, read_schema

UNBOUNDED_SPAN = 20
"""How far above its lower bound an unbounded number is drawn."""


def options_for(component: Component | OptionsSchema) -> SearchStrategy[dict[str, object]]:
    """Return options that a component's schema allows; often few, sometimes all of them."""
    schema = component
    if isinstance(component, Component):
        schema = read_schema(component.options)
    return _objects(cast("OptionsSchema", schema))


def sections(registry: Registry | None = None) -> SearchStrategy[dict[str, Mapping[str, object]]]:
    """Return values of all installed config sections, such as ``rf``, by name."""
    return st.fixed_dictionaries(
        {
            each.section.name: options_for(each.schema)
            for each in (registry or get_registry()).sections()
        }
    )


def radios(registry: Registry | None = None) -> SearchStrategy[Mapping[str, object]]:
    """Return values of the ``rf`` section; empty when no installed plug-in owns one."""
    return sections(registry).map(lambda drawn: drawn.get("rf", {}))


def _objects(schema: OptionsSchema) -> SearchStrategy[dict[str, object]]:
    properties = {name: _values(child) for name, child in properties_of(schema).items()}
    required = cast("Sequence[str]", schema.get("required", ()))
    needed = {name: properties[name] for name in required}
    optional = {name: each for name, each in properties.items() if name not in needed}
    return st.fixed_dictionaries(needed) | st.fixed_dictionaries(needed, optional=optional)


def _values(schema: Mapping[str, object]) -> SearchStrategy[object]:
    """Return what one property may be."""
    if "const" in schema:
        return st.just(schema["const"])
    if "enum" in schema:
        return st.sampled_from(cast("list[object]", schema["enum"]))
    for combination in ("anyOf", "oneOf"):
        if combination in schema:
            branches = cast("list[Mapping[str, object]]", schema[combination])
            return st.one_of([_values(each) for each in branches])
    types = schema.get("type", "object")
    names = cast("list[str]", types if isinstance(types, list) else [types])
    if "default" in schema and "pattern" not in schema:  # free text means something: keep to it
        names = [name for name in names if name != "string"]
    drawn: SearchStrategy[object] = st.one_of([_of_type(name, schema) for name in names])
    return st.just(schema["default"]) | drawn if "default" in schema else drawn


def _of_type(name: str, schema: Mapping[str, object]) -> SearchStrategy[object]:
    if name == "boolean":
        return st.booleans()
    if name == "null":
        return st.none()
    if name in ("integer", "number"):
        return _numbers(schema, is_whole=name == "integer")
    if name == "string":
        return _texts(schema)
    if name == "array":
        items = _values(cast("Mapping[str, object]", schema.get("items", {"type": "string"})))
        least = cast("int", schema.get("minItems", 0))
        most = cast("int", schema.get("maxItems", least + 3))
        return st.lists(items, min_size=least, max_size=most)
    return _objects(schema)


def _numbers(schema: Mapping[str, object], *, is_whole: bool) -> SearchStrategy[object]:
    """Return numbers within the bounds; without an upper one, not far above the lower one."""
    least = cast("float | None", schema.get("minimum", schema.get("exclusiveMinimum")))
    most = cast("float | None", schema.get("maximum", schema.get("exclusiveMaximum")))
    low = least if least is not None else (0 if most is None else most - UNBOUNDED_SPAN)
    high = most if most is not None else low + UNBOUNDED_SPAN
    is_open_below, is_open_above = "exclusiveMinimum" in schema, "exclusiveMaximum" in schema
    if is_whole:
        return st.integers(int(low) + is_open_below, int(high) - is_open_above)
    return st.floats(
        low, high, exclude_min=is_open_below, exclude_max=is_open_above, allow_subnormal=False
    )


def _texts(schema: Mapping[str, object]) -> SearchStrategy[object]:
    pattern = schema.get("pattern")
    if isinstance(pattern, str):
        return st.from_regex(pattern)
    least = cast("int", schema.get("minLength", 0))
    return st.text("abc_", min_size=least, max_size=least + 4)
