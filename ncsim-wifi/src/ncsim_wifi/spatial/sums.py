"""Sums and products whose order is known, so that compiled loops give the same bits.

numpy's own sums group their terms as suits the processor.
"""

import numpy as np

from ncsim_wifi.quantities import FloatArray, IntArray

IN_ORDER = 8
"""Up to here numpy adds from the first term to the last anyway."""

MANY_ROWS = 30
"""From here on a copy on its side is worth it: of two axes, numpy adds along the first in order."""


def row_sums(values: FloatArray) -> FloatArray:
    """Return the sums along the last axis, each from its first term to its last."""
    if values.shape[-1] < IN_ORDER:
        return np.asarray(np.add.reduce(values, axis=-1))
    if values.size < MANY_ROWS * values.shape[-1]:
        sums: FloatArray = np.add.accumulate(values, axis=-1)[..., -1]
        return sums
    rows = values.reshape(-1, values.shape[-1])
    return np.asarray(np.add.reduce(rows.T.copy(), axis=0).reshape(values.shape[:-1]))


def column_sums(values: FloatArray) -> FloatArray:
    """Return the sums along the first axis of two, each from its first term to its last.

    Args:
        values: Two columns or more; a single one numpy would add by blocks.
    """
    return np.asarray(np.add.reduce(values, axis=0))


def row_products(values: FloatArray) -> FloatArray:
    """Return the products along the last axis of two, each from its first factor to its last."""
    if len(values) < MANY_ROWS:
        return np.asarray(np.multiply.accumulate(values, axis=-1)[..., -1])
    return np.asarray(np.multiply.reduce(values.T.copy(), axis=0))


def sums_by(place: IntArray, values: FloatArray, count: int) -> FloatArray:
    """Return the sums of the rows of each place, in their order, shape (count, columns).

    Args:
        place: Of each row.
        values: Shape (rows, columns).
        count: Number of places.
    """
    columns = values.shape[1]
    cells = (place[:, None] * columns + np.arange(columns)).ravel()
    sums = np.bincount(cells, values.ravel(), count * columns)
    return np.asarray(sums, np.float64).reshape(count, columns)


def products_by(place: IntArray, factors: FloatArray, count: int) -> FloatArray:
    """Return the product of the factors of each place, in their order, 1 where there are none.

    Args:
        place: Of each factor.
        factors: One for each place.
        count: Number of places.
    """
    products = np.ones(count)
    np.multiply.at(products, place, factors)
    return products


def starts_of(number: IntArray) -> IntArray:
    """Return where each run of equal numbers begins.

    >>> starts_of(np.array([3, 3, 5, 5, 5, 9])).tolist()
    [0, 2, 5]
    """
    is_first = np.ones(len(number), np.bool_)
    np.not_equal(number[1:], number[:-1], out=is_first[1:])
    return is_first.nonzero()[0]
