import pytest
import yaml
from ncsim_core.scenario.positions import Span
from ncsim_core.scenario.yaml_reader import MAX_DEPTH, read_yaml


def slips_of(text):
    return [slip.message for slip in read_yaml(text).slips]


def test_values_and_keys_have_positions():
    positions = read_yaml("a:\n  - {b: 1, c: word}\n", with_positions=True).positions

    assert positions.values["a", 0, "c"] == Span(2, 15, 4)
    assert positions.keys["a", 0, "c"] == Span(2, 12, 1)
    assert positions.find(("a", 0, "missing")) == Span(2, 5, 1)


def test_aliases_stand_for_equal_values():
    assert read_yaml("a: &x {n: 1}\nb: *x\nc: [*x, *x]\n").document == {
        "a": {"n": 1},
        "b": {"n": 1},
        "c": [{"n": 1}, {"n": 1}],
    }


def test_an_anchor_may_be_given_anew():
    assert read_yaml("a: &x 1\nb: &x 2\nc: *x\n").document == {"a": 1, "b": 2, "c": 2}


def test_quoted_words_are_text():
    assert read_yaml("""a: '1'\nb: "true"\nc: !!str 5\n""").document == {
        "a": "1",
        "b": "true",
        "c": "5",
    }


def test_a_deep_but_allowed_nesting_is_read():
    text = "[" * MAX_DEPTH + "]" * MAX_DEPTH

    assert slips_of(text) == []


def test_all_repeated_keys_are_reported():
    assert slips_of("{a: 1, b: 2, a: 3, b: 4}") == [
        "key 'a' is given twice, first on line 1",
        "key 'b' is given twice, first on line 1",
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("? {a: 1}\n: 2\n", "a key must be text, not a mapping or a list"),
        ("a: &x b\n*x : 1\n", "an alias cannot be a key; write the key out"),
        ("a: !thing {}\n", "the YAML tag '!thing' is not supported; write a plain value"),
    ],
)
def test_forms_that_no_scenario_needs_are_refused(text, message):
    assert slips_of(text) == [message]


def test_a_decimal_comma_is_told_as_one():
    assert slips_of("{data_size: 8,5}") == [
        "a key must be text, not 5; put it in quotes, or write 8.5 if that is one number"
    ]


def test_a_million_brackets_do_no_harm():
    assert slips_of("[" * 1_000_000) == [f"nested more than {MAX_DEPTH} levels deep"]


def test_without_the_c_library_the_reading_is_the_same(monkeypatch):
    text = "# über\na: &x [1, 'ö', {b: 12:30}]\nc: *x\n"
    fast = read_yaml(text, with_positions=True)
    monkeypatch.delattr(yaml, "CSafeLoader", raising=False)

    assert read_yaml(text, with_positions=True) == fast
