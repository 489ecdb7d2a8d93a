"""Which stations are on the air together, set by set and clique by clique.

Source: MODEL 3.3; see ``ncsim_wifi.spatial.occupancy`` and ``ncsim_wifi.spatial.belief``.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray
from ncsim_wifi.spatial.belief import ACCURACY, DAMPING, MAX_SWEEPS
from ncsim_wifi.spatial.occupancy import FINE, ROUGH, Occupancy, OccupancyModel


class Lists(NamedTuple):
    """Several lists one behind the other: number i begins at ``starts[i]``."""

    starts: IntArray
    items: IntArray


class SetLists(NamedTuple):
    """All independent sets of the components that are exact; see ``SetTable``."""

    components: int
    component: IntArray
    parent: IntArray
    added: IntArray
    leaves_idle: Lists
    members: Lists


class Beliefs(NamedTuple):
    """The other components; see ``CliqueBelief``.

    Args:
        starts: The first entry of each component, and the end.
        cliques: Their number in all.
        clique: The clique of each entry.
        station: Its station.
        of_station: The entries of each station, none where its component is exact.
    """

    starts: IntArray
    cliques: int
    clique: IntArray
    station: IntArray
    of_station: Lists


class Graph(NamedTuple):
    """The sensing graph: the component of each station, and the lists of both kinds."""

    part: IntArray
    sets: SetLists
    beliefs: Beliefs


def listed(chosen: Sequence[BoolArray], names: Sequence[IntArray]) -> Lists:
    """Return which columns are chosen in each row of some tables, by the names of columns."""
    sizes = [0, *(size for table in chosen for size in table.sum(axis=1).tolist())]
    items = [name[table.nonzero()[1]] for table, name in zip(chosen, names, strict=True)]
    return Lists(np.cumsum(sizes), np.concatenate([*items, np.zeros(0, np.int64)]))


@lru_cache(maxsize=256)
def graph_of(model: OccupancyModel) -> Graph:
    """Return the lists of a sensing graph."""
    part = np.empty(len(model.senses), np.int64)
    for number, (stations, _) in enumerate(model.parts):
        part[stations] = number
    return Graph(part, _sets_of(model), _beliefs_of(model))


def _sets_of(model: OccupancyModel) -> SetLists:
    exact = [(stations, sets) for stations, sets in model.parts if sets is not None]
    component: list[int] = []
    parent: list[int] = []
    added: list[int] = []
    holds: list[BoolArray] = []
    leaves_idle: list[BoolArray] = []
    for number, (stations, sets) in enumerate(exact):
        in_order = sorted(sets, key=lambda held: (held.bit_count(), held))
        place = {held: at for at, held in enumerate(in_order, len(parent))}
        last = [held.bit_length() - 1 for held in in_order]
        component += [number] * len(in_order)
        parent += [
            place[held ^ 1 << most] if held else place[held]
            for held, most in zip(in_order, last, strict=True)
        ]
        added += stations[last].tolist()
        holds.append(bits_of(in_order, len(stations)))
        closed = model.senses[stations[:, None], stations] | np.eye(len(stations), dtype=np.bool_)
        leaves_idle.append(holds[-1].astype(np.float64) @ closed == 0.0)
    names = [stations for stations, _ in exact]
    return SetLists(
        len(exact),
        np.array(component, np.int64),
        np.array(parent, np.int64),
        np.array(added, np.int64),
        listed(leaves_idle, names),
        listed(holds, names),
    )


def bits_of(numbers: Sequence[int], count: int) -> BoolArray:
    """Return the lowest bits of some numbers, shape (numbers, count).

    >>> bits_of([1, 6], 3).tolist()
    [[True, False, False], [False, True, True]]
    """
    size = (count + 7) // 8
    held = np.frombuffer(b"".join(each.to_bytes(size, "little") for each in numbers), np.uint8)
    bits = np.unpackbits(held.reshape(-1, size), axis=1, count=count, bitorder="little")
    return bits.astype(np.bool_)


def _beliefs_of(model: OccupancyModel) -> Beliefs:
    starts, cliques = [0], 0
    clique: list[int] = []
    station: list[int] = []
    for stations, belief in model.beliefs:
        clique += (belief.clique + cliques).tolist()
        station += stations[belief.station].tolist()
        cliques += belief.clique_count
        starts.append(len(clique))
    stations_of = np.array(station, np.int64)
    is_of = np.arange(len(model.senses))[:, None] == stations_of
    return Beliefs(
        np.array(starts),
        cliques,
        np.array(clique, np.int64),
        stations_of,
        listed([is_of], [np.arange(len(station))]),
    )


@inlined
def occupancy_of(graph: Graph, senses: FloatArray, activity: FloatArray) -> Occupancy:
    """Return the occupancy for rho, the activity of each station."""
    count = len(activity)
    idle, clear, on = np.zeros(count), np.zeros((count, count)), np.zeros((count, count))
    _fill_exact(graph, activity, idle, clear, on)
    _fill_beliefs(graph.beliefs, senses, activity, idle, clear, on)
    for u in range(count):
        for w in range(count):
            if graph.part[u] != graph.part[w]:
                clear[u, w], on[u, w] = idle[w], activity[w] * idle[w]
    return Occupancy(idle, clear, on)


@inlined
def _fill_exact(
    graph: Graph, activity: FloatArray, idle: FloatArray, clear: FloatArray, on: FloatArray
) -> None:
    """Fill sums over all independent sets; stations of other components see nothing."""
    sets, count = graph.sets, len(activity)
    weight = _weights(sets, activity)
    fine_clear, fine_on = np.zeros((count, count)), np.zeros((count, count))
    for held in range(len(weight)):
        rough = np.rint(weight[held] * ROUGH) / ROUGH
        fine = np.rint((weight[held] - rough) * FINE) / FINE
        ones = _list(sets.leaves_idle, held)
        for u in ones:
            for w in ones:
                clear[u, w] += rough
                fine_clear[u, w] += fine
            for w in _list(sets.members, held):
                on[u, w] += rough
                fine_on[u, w] += fine
    for u in range(count):
        idle[u] = clear[u, u] + fine_clear[u, u]
        whole = idle[u] if idle[u] > 0.0 else 1.0
        for w in range(count):
            clear[u, w] = (clear[u, w] + fine_clear[u, w]) / whole
            on[u, w] = (on[u, w] + fine_on[u, w]) / whole


@inlined
def _list(lists: Lists, number: int) -> IntArray:
    return lists.items[lists.starts[number] : lists.starts[number + 1]]


@inlined
def _weights(sets: SetLists, activity: FloatArray) -> FloatArray:
    """Return the probability of each set within its component."""
    count = len(sets.component)
    weight, total = np.ones(count), np.zeros(sets.components)
    for held in range(count):
        if sets.parent[held] != held:
            weight[held] = weight[sets.parent[held]] * activity[sets.added[held]]
        total[sets.component[held]] += weight[held]
    for held in range(count):
        weight[held] /= total[sets.component[held]]
    return weight


@inlined
def _fill_beliefs(
    beliefs: Beliefs,
    senses: FloatArray,
    activity: FloatArray,
    idle: FloatArray,
    clear: FloatArray,
    on: FloatArray,
) -> None:
    """Fill what belief propagation says of components that have too many sets."""
    odds, total = np.empty(len(beliefs.clique)), np.empty(beliefs.cliques)
    beyond = np.empty(len(odds))
    for part in range(len(beliefs.starts) - 1):
        begin, end = beliefs.starts[part], beliefs.starts[part + 1]
        _fill_odds(beliefs, activity, (begin, end), odds, total, beyond)
    for u in range(len(activity)):
        entries = _list(beliefs.of_station, u)
        if len(entries):
            on_odds = activity[u] / _product(beyond, entries)
            idle[u] = on_odds / (1.0 + on_odds) / activity[u]
    for u in range(len(activity)):
        if not len(_list(beliefs.of_station, u)):
            continue
        _fill_far(beliefs, senses[u], u, odds, total, beyond)
        for w in range(len(activity)):
            those = _list(beliefs.of_station, w)
            if not len(those):
                continue
            share = 1.0 / _product(beyond, those)
            w_on = activity[w] * share / (1.0 + activity[w] * share)
            is_closed = u == w or senses[u, w] > 0.0
            clear[u, w] = 1.0 if u == w else (share if is_closed else w_on / activity[w])
            on[u, w] = 0.0 if is_closed else w_on


@inlined
def _fill_odds(
    beliefs: Beliefs,
    activity: FloatArray,
    entries: tuple[int, int],
    odds: FloatArray,
    total: FloatArray,
    beyond: FloatArray,
) -> None:
    """Fill mu of the entries of a component, and one and the odds of others in their cliques."""
    begin, end = entries
    for entry in range(begin, end):
        odds[entry] = activity[beliefs.station[entry]]
    _fill_beyond(beliefs, begin, end, odds, total, beyond)
    for _ in range(MAX_SWEEPS):
        moved = 0.0
        for entry in range(begin, end):
            station = beliefs.station[entry]
            heard = _product(beyond, _list(beliefs.of_station, station)) / beyond[entry]
            fresh = activity[station] / heard
            moved = max(moved, abs(fresh - odds[entry]))
            odds[entry] = DAMPING * odds[entry] + (1.0 - DAMPING) * fresh
        _fill_beyond(beliefs, begin, end, odds, total, beyond)
        if moved < ACCURACY:
            break


@inlined
def _fill_beyond(
    beliefs: Beliefs, begin: int, end: int, odds: FloatArray, total: FloatArray, beyond: FloatArray
) -> None:
    """Fill one and the odds of the other members of the clique of each entry."""
    for entry in range(begin, end):
        total[beliefs.clique[entry]] = 0.0
    for entry in range(begin, end):
        total[beliefs.clique[entry]] += odds[entry]
    for entry in range(begin, end):
        beyond[entry] = 1.0 + (total[beliefs.clique[entry]] - odds[entry])


@inlined
def _fill_far(
    beliefs: Beliefs,
    senses: FloatArray,
    u: int,
    odds: FloatArray,
    total: FloatArray,
    left: FloatArray,
) -> None:
    """Fill one and the odds of those in the clique of each entry that u does not sense."""
    total[:] = 0.0
    for entry in range(len(odds)):
        w = beliefs.station[entry]
        far = 0.0 if w == u or senses[w] > 0.0 else odds[entry]
        total[beliefs.clique[entry]] += far
        left[entry] = far
    for entry in range(len(odds)):
        left[entry] = 1.0 + max(total[beliefs.clique[entry]] - left[entry], 0.0)


@inlined
def _product(factors: FloatArray, places: IntArray) -> float:
    product = factors[places[0]]
    for place in places[1:]:
        product = product * factors[place]
    return float(product)
