import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.registry import Registry
from ncsim_core.scenario.plain_fit import plain_fit
from ncsim_core.scenario.schema import compose_schema
from ncsim_core.testing.scenario_strategies import scenarios

SCHEMA = {
    "type": "object",
    "properties": {
        "n": {"type": "number", "minimum": 0, "exclusiveMaximum": 9},
        "k": {"type": ["integer", "null"], "maximum": 5, "exclusiveMinimum": -5},
        "t": {"type": "string", "minLength": 1, "maxLength": 3, "pattern": "^[a-c]+$"},
        "e": {"enum": ["x", 1, True]},
        "c": {"const": 2},
        "l": {"type": "array", "items": {"$ref": "#/definitions/b"}, "minItems": 1, "maxItems": 2},
        "o": {"anyOf": [{"type": "boolean"}, {"allOf": [{"type": "string"}, {"minLength": 2}]}]},
    },
    "required": ["n"],
    "additionalProperties": False,
    "if": {"properties": {"e": {"enum": ["x"]}}, "required": ["e"]},
    "then": {"required": ["t"]},
    "else": {"properties": {"t": {"maxLength": 2}}},
    "definitions": {"b": {"type": "boolean"}},
}
values = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-9, 9),
    st.floats(),
    st.text("abcx", max_size=4),
    st.lists(st.booleans() | st.integers(0, 1), max_size=3),
)
instances = st.dictionaries(st.sampled_from([*"nktecloz"]), values) | values


@given(instances)
def test_what_plainly_fits_is_valid_for_jsonschema_too(instance):
    if plain_fit(SCHEMA)(instance):
        jsonschema.Draft7Validator(SCHEMA).validate(instance)


@pytest.mark.parametrize(
    "instance",
    [{"n": 1}, {"n": 0, "k": None, "t": "ab"}, {"n": 1.5, "e": "x", "t": "abc", "l": [True]}],
)
def test_good_instances_plainly_fit(instance):
    assert plain_fit(SCHEMA)(instance)


@pytest.mark.parametrize(
    "schema", [{"not": {}}, {"items": [{}]}, {"if": {"minimum": 3}}, {"additionalProperties": {}}]
)
def test_a_keyword_it_does_not_know_is_left_to_jsonschema(schema):
    assert not plain_fit(schema)({})


@given(scenarios())
def test_whole_scenarios_plainly_fit(core: Registry, document):
    assert plain_fit(compose_schema(core))(document)
