"""Which stations are on the air together: the product form over independent sets.

Source: MODEL 3.3; ideal CSMA of Boorstyn (1987), Liew et al. (2010), Laufer and Kleinrock (2016).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray
from ncsim_wifi.spatial.belief import CliqueBelief, clique_belief

FEW_SETS = 64
ROUGH, FINE = 2.0**50, 2.0**92
"""Weights of up to 1500 sets, rounded to these parts of one, have sums without any rounding."""


class Occupancy(NamedTuple):
    """What the stations see of each other on the air.

    Args:
        idle: Probability that a station and all it senses are off, shape (U,).
        clear: C[u, w], that w and all it senses are off, given that for u.
        on: A[u, w], that w is on, given that u and all it senses are off.
    """

    idle: FloatArray
    clear: FloatArray
    on: FloatArray


Level = tuple[slice, IntArray, IntArray]
"""Places of sets, of those that they extend, and of the stations by which they do."""


class SetTable(NamedTuple):
    """All independent sets of some components of the sensing graph, smaller ones first.

    Args:
        component: The component of each set.
        parent: The set that it extends by one station, itself for the empty ones.
        added: That station.
        levels: The sets of 1, 2, ... stations, with what they extend by what.
        members: 1 for the stations that a set holds, shape (sets, all stations).
        leaves_idle: 1 for stations of the component that it leaves off, with all they sense.
        either: The last two side by side.
    """

    component: IntArray
    parent: IntArray
    added: IntArray
    levels: tuple[Level, ...]
    members: FloatArray
    leaves_idle: FloatArray
    either: FloatArray


def exact_occupancy(table: SetTable, activity: FloatArray) -> Occupancy:
    """Return the sums over all independent sets; stations of other components see nothing.

    Args:
        table: The sets.
        activity: rho of all stations.
    """
    weight = np.ones(len(table.component))
    for sets, parent, added in table.levels:
        np.multiply(weight.take(parent), activity.take(added), out=weight[sets])
    weight /= np.bincount(table.component, weight)[table.component]
    rough = np.rint(weight * ROUGH) / ROUGH
    fine = np.rint((weight - rough) * FINE) / FINE
    leaves_idle = table.leaves_idle.T
    sums = (leaves_idle * rough) @ table.either + (leaves_idle * fine) @ table.either
    count = len(activity)
    idle = sums.diagonal().copy()
    given = sums / np.where(idle > 0.0, idle, 1.0)[:, None]
    return Occupancy(idle, given[:, :count], given[:, count:])


def independent_sets(senses: BoolArray, limit: int) -> list[int] | None:
    """Return all sets of stations of which none senses another; ``None`` beyond a limit.

    Args:
        senses: Who senses whom, symmetric.
        limit: The most sets to list.

    Returns:
        Bit u of each is set if it holds station u.
    """
    rows = np.packbits(senses, 1, "little")
    sets = [0]
    for station, heard in enumerate(int.from_bytes(row, "little") for row in rows):
        sets += [held | 1 << station for held in sets if not held & heard]
        if len(sets) > limit:
            return None
    return sets


def set_table(senses: BoolArray, components: Sequence[tuple[IntArray, Sequence[int]]]) -> SetTable:
    """Return the table of independent sets.

    Args:
        senses: Who senses whom.
        components: Stations of each component, and its sets as bits of places among these.
    """
    every = sorted(
        (held.bit_count(), number, held)
        for number, (_, sets) in enumerate(components)
        for held in sets
    )
    place = {(number, held): at for at, (_, number, held) in enumerate(every)}
    members = np.zeros((len(every), len(senses)))
    inside = np.zeros((len(components), len(senses)))
    parent, added = [], []
    for number, (stations, _) in enumerate(components):
        inside[number, stations] = 1.0
    for at, (size, number, held) in enumerate(every):
        stations = components[number][0]
        last = held.bit_length() - 1
        parent.append(place[number, held ^ (1 << last)] if size else at)
        added.append(int(stations[last]) if size else 0)
        members[at] = members[parent[-1]]
        if size:
            members[at, added[-1]] = 1.0
    component = np.array([number for _, number, _ in every])
    closed = senses.astype(np.float64) + np.eye(len(senses))
    leaves_idle = (members @ closed == 0.0) * inside[component]
    parents, extras = np.array(parent), np.array(added)
    ends = np.cumsum(np.bincount([size for size, _, _ in every])).tolist()
    levels = [slice(begin, end) for begin, end in pairwise(ends)]
    return SetTable(
        component,
        parents,
        extras,
        tuple((sets, parents[sets], extras[sets]) for sets in levels),
        members,
        leaves_idle,
        np.concatenate([leaves_idle, members], axis=1),
    )


@dataclass(frozen=True, eq=False)
class OccupancyModel:
    """Connected components of the sensing graph do not see each other.

    Args:
        senses: Who senses whom.
        parts: Stations of each component, and all its independent sets unless there are too many.
    """

    senses: BoolArray
    parts: tuple[tuple[IntArray, Sequence[int] | None], ...]

    @cached_property
    def tables(self) -> list[tuple[IntArray, SetTable]]:
        """Return the tables of components with all their sets, one for all small components."""
        exact = [(stations, sets) for stations, sets in self.parts if sets is not None]
        small = [part for part in exact if len(part[1]) <= FEW_SETS]
        shared = [[part] for part in exact if len(part[1]) > FEW_SETS] + ([small] if small else [])
        return [_table_of(self.senses, parts) for parts in shared]

    @cached_property
    def beliefs(self) -> list[tuple[IntArray, CliqueBelief]]:
        """Return the models of the other components."""
        return [
            (stations, clique_belief(self.senses[np.ix_(stations, stations)]))
            for stations, sets in self.parts
            if sets is None
        ]

    @cached_property
    def _are_apart(self) -> BoolArray | None:
        """Return who is in another component than whom; nobody if there is only one."""
        if len(self.parts) == 1:
            return None
        number = np.empty(len(self.senses))
        for at, (stations, _) in enumerate(self.parts):
            number[stations] = at
        return np.asarray(number[:, None] != number)

    def __call__(self, activity: FloatArray) -> Occupancy:
        """Return the occupancy for rho, the activity of each station."""
        found = self._of_components(activity)
        if self._are_apart is None:
            return found
        return Occupancy(
            found.idle,
            np.where(self._are_apart, found.idle, found.clear),
            np.where(self._are_apart, activity * found.idle, found.on),
        )

    def _of_components(self, activity: FloatArray) -> Occupancy:
        """Return the occupancy, but for what components see of each other."""
        count = len(activity)
        if len(self.tables) == 1 and not self.beliefs:
            return exact_occupancy(self.tables[0][1], activity)
        found = Occupancy(np.empty(count), np.empty((count, count)), np.empty((count, count)))
        for stations, table in self.tables:
            self._write(found, stations, exact_occupancy(table, activity[stations]))
        for stations, model in self.beliefs:
            self._write(found, stations, model(activity[stations]))
        return found

    @staticmethod
    def _write(found: Occupancy, stations: IntArray, within: Occupancy) -> None:
        pairs = (stations[:, None] * len(found.idle) + stations).ravel()
        found.idle[stations] = within.idle
        found.clear.reshape(-1)[pairs] = within.clear.ravel()
        found.on.reshape(-1)[pairs] = within.on.ravel()


def _table_of(
    senses: BoolArray, parts: Sequence[tuple[IntArray, Sequence[int]]]
) -> tuple[IntArray, SetTable]:
    """Return the stations of some components, ascending, and the table of their sets."""
    stations = np.sort(np.concatenate([part for part, _ in parts]))
    renamed = [(np.searchsorted(stations, part), sets) for part, sets in parts]
    return stations, set_table(senses[np.ix_(stations, stations)], renamed)


def connected_components(related: BoolArray) -> list[IntArray]:
    """Return the connected components of a symmetric relation, each ascending."""
    count = len(related)
    left = np.ones(count, np.bool_)
    components = []
    for first in range(count):
        if not left[first]:
            continue
        reached = np.zeros(count, np.bool_)
        frontier = reached.copy()
        frontier[first] = True
        while frontier.any():
            reached |= frontier
            frontier = related[frontier].any(axis=0) & ~reached
        left &= ~reached
        components.append(np.flatnonzero(reached))
    return components


def occupancy_of(senses: BoolArray, max_sets: int) -> OccupancyModel:
    """Return the occupancy model of a sensing graph.

    Args:
        senses: Who senses whom, symmetric.
        max_sets: Independent sets of a component up to which it is exact, at most 1500.
    """
    return _model_of(len(senses), senses.tobytes(), max_sets)


@lru_cache(maxsize=256)
def _model_of(count: int, senses_bytes: bytes, max_sets: int) -> OccupancyModel:
    """Return the model of a sensing graph; many active sets have the same."""
    senses = np.frombuffer(senses_bytes, np.bool_).reshape(count, count)
    parts = connected_components(senses)
    return OccupancyModel(
        senses,
        tuple((part, independent_sets(senses[np.ix_(part, part)], max_sets)) for part in parts),
    )
