"""Exponential and logarithm of our own against those of the C library."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_wifi.spatial import elementary

UNITS = 2.0


def units_apart(found, expected):
    return abs(found - expected) / math.ulp(expected)


@given(st.floats(-700, 700))
def test_exponential_is_right_to_two_units_in_the_last_place(exponent):
    (found,) = elementary.exp(np.array([exponent])).tolist()

    assert units_apart(found, math.exp(exponent)) <= UNITS


@given(st.one_of(st.floats(1e-300, 1e300), st.floats(0.5, 2.0)))
def test_logarithm_is_right_to_two_units_in_the_last_place(value):
    (found,) = elementary.log(np.array([value])).tolist()

    assert abs(found - math.log(value)) <= UNITS * max(math.ulp(math.log(value)), 2.0**-53)


def test_far_arguments_count_as_the_farthest():
    assert elementary.exp(np.array([-1e9]))[0] == pytest.approx(math.exp(-700.0), rel=1e-15)
    assert elementary.log(np.zeros(1))[0] == pytest.approx(-1000 * math.log(2.0), rel=1e-15)


def test_loops_give_the_bits_of_arrays():
    pytest.importorskip("numba")
    from ncsim_core.compiling import NUMBA
    from ncsim_wifi.spatial.compiled.elementary import exp, log

    @NUMBA.njit(error_model="numpy")
    def both(values):
        return np.array([exp(value) for value in values]), np.array([log(abs(v)) for v in values])

    values = np.random.default_rng(1).uniform(-50.0, 50.0, 2000)

    one, other = both(values)

    assert one.tobytes() == elementary.exp(values).tobytes()
    assert other.tobytes() == elementary.log(np.abs(values)).tobytes()
