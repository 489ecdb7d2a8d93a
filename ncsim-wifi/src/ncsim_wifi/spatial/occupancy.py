"""Which stations are on the air together: the product form over independent sets.

Source: MODEL 3.3; ideal CSMA of Boorstyn (1987), Liew et al. (2010), Laufer and Kleinrock (2016).
"""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from typing_extensions import override

from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray
from ncsim_wifi.spatial.belief import clique_belief


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


class OccupancyModel(Protocol):
    """Answers for one connected component of the sensing graph."""

    def __call__(self, activity: FloatArray) -> Occupancy:
        """Return the occupancy for rho, the activity of each station."""


@dataclass(frozen=True)
class ExactOccupancy(OccupancyModel):
    """Sums over all independent sets.

    Args:
        members: Which stations a set holds, shape (sets, stations), 0 or 1.
        leaves_idle: Whether a set leaves a station and all it senses off.
    """

    members: FloatArray
    leaves_idle: FloatArray

    @override
    def __call__(self, activity: FloatArray) -> Occupancy:
        weight = np.exp(self.members @ np.log(activity))
        weight /= weight.sum()
        weighted = self.leaves_idle * weight[:, None]
        idle = weighted.sum(axis=0)
        clear = weighted.T @ self.leaves_idle / idle[:, None]
        on = weighted.T @ self.members / idle[:, None]
        return Occupancy(idle, clear, on)


def independent_sets(senses: BoolArray, limit: int) -> FloatArray | None:
    """Return all sets of stations of which none senses another; ``None`` beyond a limit.

    Args:
        senses: Who senses whom, symmetric.
        limit: The most sets to list.
    """
    neighbours = [sum(1 << int(w) for w in np.flatnonzero(row)) for row in senses]
    sets = [0]
    for station, heard in enumerate(neighbours):
        sets += [held | 1 << station for held in sets if not held & heard]
        if len(sets) > limit:
            return None
    bits = np.array([[held >> u & 1 for u in range(len(neighbours))] for held in sets])
    return bits.astype(np.float64)


def occupancy_model(senses: BoolArray, max_sets: int) -> OccupancyModel:
    """Return the exact sums, or belief propagation where there are too many sets."""
    members = independent_sets(senses, max_sets)
    if members is None:
        return clique_belief(senses)
    closed = senses.astype(np.float64) + np.eye(len(senses))
    return ExactOccupancy(members, (members @ closed == 0.0).astype(np.float64))


@dataclass(frozen=True)
class ComponentwiseOccupancy(OccupancyModel):
    """Connected components of the sensing graph do not see each other.

    Args:
        components: Stations of each, and its model.
    """

    components: tuple[tuple[IntArray, OccupancyModel], ...]

    @override
    def __call__(self, activity: FloatArray) -> Occupancy:
        count = len(activity)
        idle = np.empty(count)
        clear = np.empty((count, count))
        on = np.empty((count, count))
        for stations, model in self.components:
            within = model(activity[stations])
            idle[stations] = within.idle
            clear[:, stations] = within.idle
            on[:, stations] = activity[stations] * within.idle
            clear[np.ix_(stations, stations)] = within.clear
            on[np.ix_(stations, stations)] = within.on
        return Occupancy(idle, clear, on)


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
    """Return the occupancy model of a sensing graph, component by component."""
    parts = connected_components(senses)
    models = [(part, occupancy_model(senses[np.ix_(part, part)], max_sets)) for part in parts]
    return models[0][1] if len(models) == 1 else ComponentwiseOccupancy(tuple(models))
