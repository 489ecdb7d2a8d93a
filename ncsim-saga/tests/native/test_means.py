"""Sums and means agree with numpy to the last bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_saga.native.means import mean_quotient, pairwise_sum


@settings(deadline=None)
@given(st.lists(st.floats(1e-6, 1e6), max_size=60))
def test_short_sums_are_numpys(values):
    assert pairwise_sum(values) == np.add.reduce(np.array(values, float))


@pytest.mark.parametrize("count", [1, 7, 8, 9, 127, 128, 129, 256, 1000, 2304, 10_001])
def test_long_means_are_numpys(count):
    divisors = np.random.default_rng(count).lognormal(0, 2, count)

    expected = np.mean([3.7 / divisor for divisor in divisors.tolist()])
    assert mean_quotient(3.7, divisors.tolist()) == expected
    assert np.mean(3.7 / divisors) == expected
