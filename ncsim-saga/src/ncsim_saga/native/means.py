"""Averages that agree with ``numpy.mean`` to the last bit, with and without numpy.

numpy adds up long arrays in halves, and short ones in eight interleaved strands. SAGA ranks
tasks by such averages, and equal or nearly equal ranks decide placements.

Source: ``pairwise_sum`` in numpy's ``loops_utils.h.src``; a test compares the two.
"""

from collections.abc import Sequence

STRANDS = 8
LONGEST_UNSPLIT = 128


def pairwise_sum(values: Sequence[float]) -> float:
    """Return the sum that numpy's ``add.reduce`` gives.

    >>> pairwise_sum([0.1] * 10) == sum([0.1] * 10)
    False
    """
    count = len(values)
    if count < STRANDS:
        total = 0.0
        for value in values:
            total += value
        return total
    if count <= LONGEST_UNSPLIT:
        return _in_strands(values)
    half = count // 2
    half -= half % STRANDS
    return pairwise_sum(values[:half]) + pairwise_sum(values[half:])


def _in_strands(values: Sequence[float]) -> float:
    """Return the sum of 8 to 128 numbers."""
    whole = len(values) - len(values) % STRANDS
    s0, s1, s2, s3, s4, s5, s6, s7 = values[:STRANDS]
    for at in range(STRANDS, whole, STRANDS):
        s0 += values[at]
        s1 += values[at + 1]
        s2 += values[at + 2]
        s3 += values[at + 3]
        s4 += values[at + 4]
        s5 += values[at + 5]
        s6 += values[at + 6]
        s7 += values[at + 7]
    total = ((s0 + s1) + (s2 + s3)) + ((s4 + s5) + (s6 + s7))
    for value in values[whole:]:
        total += value
    return total


def mean_quotient(dividend: float, divisors: Sequence[float]) -> float:
    """Return the mean of ``dividend / d`` over all divisors."""
    return pairwise_sum([dividend / divisor for divisor in divisors]) / len(divisors)
