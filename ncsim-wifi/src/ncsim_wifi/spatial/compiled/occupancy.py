"""Which stations are on the air together, set by set.

Source: MODEL 3.3; see ``ncsim_wifi.spatial.occupancy``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray, IntArray
from ncsim_wifi.spatial.occupancy import FINE, ROUGH, Occupancy, SetTable


@inlined
def exact_occupancy(table: SetTable, activity: FloatArray) -> Occupancy:
    """Return the sums over all independent sets; stations of other components see nothing."""
    sets, count = table.members.shape
    weight = _weights(table, activity)
    clear, on = np.zeros((2, count, count)), np.zeros((2, count, count))
    idle_ones, members = np.empty(count, np.int64), np.empty(count, np.int64)
    for held in range(sets):
        rough = np.rint(weight[held] * ROUGH) / ROUGH
        fine = np.rint((weight[held] - rough) * FINE) / FINE
        some = _listed(table.leaves_idle[held], idle_ones)
        size = _listed(table.members[held], members)
        for u in some:
            for w in some:
                clear[0, u, w] += rough
                clear[1, u, w] += fine
            for w in size:
                on[0, u, w] += rough
                on[1, u, w] += fine
    return _normalised(clear, on)


@inlined
def _weights(table: SetTable, activity: FloatArray) -> FloatArray:
    """Return the probability of each set within its component."""
    sets = len(table.component)
    weight, total = np.ones(sets), np.zeros(sets)
    for held in range(sets):
        if table.parent[held] != held:
            weight[held] = weight[table.parent[held]] * activity[table.added[held]]
        total[table.component[held]] += weight[held]
    for held in range(sets):
        weight[held] /= total[table.component[held]]
    return weight


@inlined
def _listed(row: FloatArray, places: IntArray) -> IntArray:
    """Return the places of ones in a row."""
    found = 0
    for place in range(len(row)):
        if row[place] > 0.0:
            places[found] = place
            found += 1
    return places[:found]


@inlined
def _normalised(clear: FloatArray, on: FloatArray) -> Occupancy:
    """Return the occupancy from sums of rough and fine weights."""
    count = clear.shape[1]
    idle = np.empty(count)
    for u in range(count):
        idle[u] = clear[0, u, u] + clear[1, u, u]
        whole = idle[u] if idle[u] > 0.0 else 1.0
        for w in range(count):
            clear[0, u, w] = (clear[0, u, w] + clear[1, u, w]) / whole
            on[0, u, w] = (on[0, u, w] + on[1, u, w]) / whole
    return Occupancy(idle, clear[0], on[0])
