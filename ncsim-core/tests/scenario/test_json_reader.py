"""JSON: its positions are those of the YAML reader, and what ``json`` lets pass is caught."""

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.scenario.faults import ScenarioFaults
from ncsim_core.scenario.json_reader import RepeatedKeyError, json_positions, json_slips, read_json
from ncsim_core.scenario.loader import parse_scenario
from ncsim_core.scenario.positions import Span
from ncsim_core.scenario.yaml_reader import read_yaml
from ncsim_core.testing.scenario_strategies import scenarios

WORDS = st.text(st.characters(codec="ascii", categories=("L", "N", "P", "Zs")), max_size=8)
SCALARS = st.none() | st.booleans() | st.integers(-999, 999) | st.floats(-9, 9) | WORDS
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(WORDS, inner, max_size=4),
    max_leaves=20,
)
BROKEN = """{"scenario": {
\t"network": {
\t\t"nodes": [
\t\t\t{"id": "a", "compute_capacity": 1},
\t\t\t{"id": "b", "compute_capacity": %s}
\t\t],
\t\t"links": [{"id": "ab", "from": "a", "to": "%s", "bandwidth": 1%s}]
\t},
\t"dags": [{"id": "d", "tasks": [{"id": "T", "compute_cost": 1}]}]
}}"""


def faults_of(text, name="x.json"):
    with pytest.raises(ScenarioFaults) as raised:
        parse_scenario(text, name=name)
    return [(each.line, each.column, each.message) for each in raised.value.faults]


@given(VALUES, st.sampled_from([None, 1, 4]))
def test_positions_are_those_of_the_yaml_reader(value, indent):
    text = json.dumps({"root": value}, indent=indent)
    expected = read_yaml(text, with_positions=True).positions

    assert json_positions(text) == expected


@given(VALUES)
def test_data_is_what_json_loads_reads(value):
    text = json.dumps([value])

    assert read_json(text) == json.loads(text)


@given(scenarios())
def test_a_scenario_is_the_same_from_yaml_and_json(document):
    scenario = parse_scenario(document)

    assert parse_scenario(json.dumps(document)) == scenario
    assert parse_scenario(scenario.to_yaml()) == scenario
    assert parse_scenario(scenario.to_yaml()).sha256 == scenario.sha256


def test_a_key_given_twice_is_a_slip_at_the_second():
    text = '{"a": 1,\n "b": {"c": 1, "c": 2},\n "a": 3}'

    with pytest.raises(RepeatedKeyError):
        read_json(text)
    assert [(slip.path, slip.span) for slip in json_slips(text)] == [
        (("b", "c"), Span(2, 16, 3)),
        (("a",), Span(3, 2, 3)),
    ]


def test_keys_given_twice_are_told_beside_other_faults():
    assert faults_of(BROKEN % ("-1", "b", ', "bandwidth": 2')) == [
        (5, 36, "must be greater than 0, not -1"),
        (7, 66, "key 'bandwidth' is given twice, first on line 7"),
    ]


def test_tabs_and_escapes_do_not_move_a_fault():
    [(line, column, message)] = faults_of(BROKEN % ("1", "b\\ud83d\\ude00", ""))

    assert (line, column) == (7, 45)
    assert message.startswith("no node 'b\U0001f600'")


@pytest.mark.parametrize("word", ["NaN", "Infinity", "-Infinity", "1e999", "9" * 400])
def test_numbers_that_are_not_finite_are_refused_where_they_stand(word):
    [(line, column, message)] = faults_of(BROKEN % (word, "b", ""))

    assert (line, column) == (5, 36)
    assert message.startswith(("must be a finite number", "must be greater than 0"))


def test_an_integer_beyond_any_float_is_infinite():
    assert read_json("9" * 400) == math.inf
    assert read_json("-" + "9" * 5000) == -math.inf


@pytest.mark.parametrize("half", ["\\ud800", "\\udc00", "\\\\\\ud83d", "\\ud83d\\ud83d\\ude00"])
def test_half_a_surrogate_pair_is_refused(half):
    with pytest.raises(json.JSONDecodeError, match="Half a surrogate pair"):
        read_json(f'{{"a": "{half}"}}')


@pytest.mark.parametrize("whole", ["\\ud83d\\ude00", "\\\\ud800", "\\ud83d\\ude00\\ud83d\\ude00"])
def test_whole_pairs_and_escaped_backslashes_are_text(whole):
    assert read_json(f'"{whole}"').encode()


def test_a_line_separator_inside_a_text_is_no_new_line():
    [(line, column, _)] = faults_of(BROKEN % ("1", "b\u2028c", ""))

    assert (line, column) == (7, 45)
