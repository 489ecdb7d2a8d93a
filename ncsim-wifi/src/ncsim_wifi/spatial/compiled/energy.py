"""Who is silenced by summed power, row by row.

Source: MODEL 3.6; see ``ncsim_wifi.spatial.energy``.
"""

import numpy as np

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.compiled.compiling import compiled
from ncsim_wifi.spatial.energy import TINY, GateMasks, Silenced, Silencing


@compiled
def silenced_by(tables: Silencing, on: FloatArray) -> Silenced:
    """Return how likely stations are silenced, and the gates that follow."""
    weight = np.empty(tables.feasible.shape)
    blocked = np.empty(len(on))
    for row in range(len(on)):
        blocked[row] = _fill_weights(tables, on, row, weight)
    return Silenced(
        blocked,
        _gate(weight, tables.before, tables.relation_count),
        _gate(weight, tables.during, tables.relation_count),
    )


@compiled
def _fill_weights(tables: Silencing, on: FloatArray, row: int, weight: FloatArray) -> float:
    """Fill the weight of each subset of one row; return B."""
    weight[row, 0] = 1.0
    for member in range(on.shape[1]):
        odds = on[row, member] / (1.0 - on[row, member])
        half = 1 << member
        for held in range(half):
            weight[row, half + held] = weight[row, held] * odds
    blocking = total = 0.0
    for held in range(weight.shape[1]):
        weight[row, held] = weight[row, held] * tables.feasible[row, held]
        blocking = blocking + weight[row, held] * tables.blocks[row, held]
        total = total + weight[row, held]
    return blocking / total


@compiled
def _gate(weight: FloatArray, masks: GateMasks, count: int) -> FloatArray:
    """Return P(not silenced | with it) / P(not silenced | without), at most 1, by relation."""
    result = np.ones(count)
    for at in range(len(masks.relation)):
        row = masks.row[at]
        free_with = all_with = free_without = all_without = 0.0
        for held in range(weight.shape[1]):
            free_with = free_with + masks.subsets[0, at, held] * weight[row, held]
            all_with = all_with + masks.subsets[1, at, held] * weight[row, held]
            free_without = free_without + masks.subsets[2, at, held] * weight[row, held]
            all_without = all_without + masks.subsets[3, at, held] * weight[row, held]
        with_it, without = free_with / (all_with + TINY), free_without / (all_without + TINY)
        result[masks.relation[at]] = min(1.0, with_it / max(without, TINY))
    return result
