"""Who is silenced by summed power, row by row.

Source: MODEL 3.6; see ``ncsim_wifi.spatial.energy``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.compiled.state import State, Traffic
from ncsim_wifi.spatial.compiled.tables import Constants, Energy, Records
from ncsim_wifi.spatial.energy import KINDS, TINY, GateMasks, Silenced, Silencing
from ncsim_wifi.spatial.overlap import LARGEST_ON, LEAST_ON


@inlined
def gates_of(
    constants: Constants, energy: Energy, relations: Records, state: State, traffic: Traffic
) -> tuple[FloatArray, FloatArray]:
    """Return al and be of each relation, and update B."""
    count, times = len(relations), traffic.times
    if not len(energy.station):
        return np.ones(count), np.ones(count)
    rows, members = energy.member.shape
    on = np.empty((rows, members))
    for row in range(rows):
        for place in range(members):
            w = energy.member[row, place]
            stretch = (times.on_air_us[w] + constants.energy_tail_us) / times.busy_us[w]
            part = traffic.on[energy.station[row], w] * stretch
            on[row, place] = min(max(part, LEAST_ON), LARGEST_ON)
    found = silenced_by(energy.silencing, on)
    for row in range(len(on)):
        own = state.stations[energy.station[row]]
        fresh = own.blocked + constants.gain * (found.blocked[row] - own.blocked)
        own.blocked = min(fresh, LARGEST_ON)
    for at in range(count):
        found.during[at] = 1.0 - (1.0 - found.during[at]) * relations[at].protection_ends
    return found.before, found.during


@inlined
def silenced_by(tables: Silencing, on: FloatArray) -> Silenced:
    """Return how likely stations are silenced, and the gates that follow."""
    weight = np.empty(tables.feasible.shape)
    blocked = np.empty(len(on))
    for row in range(len(on)):
        blocked[row] = _fill_weights(tables, on, row, weight)
    count = tables.relation_count
    gates = _open_gates(weight, tables.gates, 2 * count)
    return Silenced(blocked, gates[:count], gates[count:])


@inlined
def _fill_weights(tables: Silencing, on: FloatArray, row: int, weight: FloatArray) -> float:
    """Fill the weight of each subset of one row; return B."""
    weight[0, row] = 1.0
    for member in range(on.shape[1]):
        odds = on[row, member] / (1.0 - on[row, member])
        half = 1 << member
        for held in range(half):
            weight[half + held, row] = weight[held, row] * odds
    blocking = every = 0.0
    for held in range(len(weight)):
        weight[held, row] = weight[held, row] * tables.feasible[held, row]
        blocking = blocking + weight[held, row] * tables.blocks[held, row]
        every = every + weight[held, row]
    return blocking / every


@inlined
def _open_gates(weight: FloatArray, masks: GateMasks, count: int) -> FloatArray:
    """Return P(not silenced | with it) / P(not silenced | without), at most 1, by gate."""
    result = np.ones(count)
    sums = np.empty(KINDS)
    for at in range(len(masks.gate)):
        sums[:] = 0.0
        for held in range(len(weight)):
            part = weight[held, masks.row[at]]
            for kind in range(KINDS):
                sums[kind] += masks.subsets[held, at, kind] * part
        with_it = sums[0] / (sums[1] + TINY)
        without = sums[2] / (sums[3] + TINY)
        result[masks.gate[at]] = min(1.0, with_it / max(without, TINY))
    return result
