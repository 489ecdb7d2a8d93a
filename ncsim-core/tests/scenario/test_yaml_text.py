import math

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.scenario.yaml_reader import read_yaml
from ncsim_core.scenario.yaml_text import dump_yaml, plain_value

plain_data = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=10,
)


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("5e9", 5e9),
        ("1e-3", 1e-3),
        ("5.0e9", 5e9),
        (".5", 0.5),
        ("-7", -7),
        ("+3.", 3.0),
        (".inf", math.inf),
        ("-.inf", -math.inf),
        ("9" * 400, math.inf),
    ],
)
def test_numbers_of_yaml_1_2_are_numbers(word, value):
    assert plain_value(word) == value
    assert type(plain_value(word)) is type(value)


@pytest.mark.parametrize(
    "word",
    [
        "yes",
        "no",
        "on",
        "off",
        "12:30",
        "017",
        "0x1F",
        "0o7",
        "1_000",
        "2026-08-02",
        "n0",
        "-",
        ".",
    ],
)
def test_words_that_yaml_1_1_reads_differently_stay_text(word):
    assert plain_value(word) == word


def test_dot_nan_is_not_a_number():
    assert math.isnan(plain_value(".nan"))


@given(plain_data)
def test_what_is_dumped_reads_back_equal(data):
    assert read_yaml(dump_yaml({"data": data})).document == {"data": data}


@given(plain_data)
def test_what_is_dumped_reads_the_same_for_yaml_1_1(data):
    assert yaml.safe_load(dump_yaml({"data": data})) == {"data": data}
