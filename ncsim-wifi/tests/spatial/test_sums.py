"""Sums and products with arrays, against plain loops: the same bits, few rows or many."""

from functools import reduce
from operator import add, mul

import numpy as np
import pytest
from ncsim_wifi.spatial.sums import (
    MANY_ROWS,
    column_sums,
    products_by,
    row_products,
    row_sums,
    sums_by,
)

SHAPES = [(rows, terms) for rows in (1, 2, MANY_ROWS - 1, MANY_ROWS, 200) for terms in (1, 7, 50)]


def values_of(shape):
    """Return numbers whose sums depend on the order in which they are added."""
    random = np.random.default_rng(sum(shape))
    return random.normal(size=shape) * 10.0 ** random.integers(-8, 8, shape)


@pytest.mark.parametrize("shape", [*SHAPES, (5, 6, 7), (7, 7, 4, 13)])
def test_rows_are_added_from_the_first_term_to_the_last(shape):
    values = values_of(shape)

    expected = [reduce(add, row) for row in values.reshape(-1, shape[-1]).tolist()]

    assert row_sums(values).shape == shape[:-1]
    assert row_sums(values).ravel().tolist() == expected


@pytest.mark.parametrize("shape", SHAPES)
def test_rows_are_multiplied_from_the_first_factor_to_the_last(shape):
    values = values_of(shape)

    expected = [reduce(mul, row) for row in values.tolist()]

    assert row_products(values).tolist() == expected


@pytest.mark.parametrize("shape", [(64, 2), (64, 4), (50, 7), (7, 200)])
def test_columns_are_added_from_the_first_term_to_the_last(shape):
    values = values_of(shape)

    assert column_sums(values).tolist() == [reduce(add, column) for column in values.T.tolist()]


def test_sums_and_products_by_place_go_in_the_order_of_rows():
    values, place = values_of((40, 3)), np.arange(40) % 3

    of_first = values[place == 0].T.tolist()

    assert sums_by(place, values, 4)[0].tolist() == [reduce(add, column) for column in of_first]
    assert products_by(place, values[:, 0], 4)[0] == reduce(mul, of_first[0])
    assert products_by(place, values[:, 0], 4)[3] == 1.0
