"""The nodes of a network while a plan is made: who is free when, and how long things take.

Two implementations give equal answers: ``ListProcessors`` here needs no numpy and suits small
networks, ``ArrayProcessors`` asks all nodes at once.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import cache
from typing import TypeAlias

from typing_extensions import override

from ncsim_saga.native.means import mean_quotient, pairwise_sum
from ncsim_saga.native.planning_network import PlanningNetwork
from ncsim_saga.native.timeline import Timeline

Inputs: TypeAlias = Sequence[tuple[int, float, float]]
"""For each input of a task: the position it comes from, when it is there (s), its size (MB)."""


class Processors(ABC):
    """Nodes by position, with what has been booked on them.

    Args:
        network: The network.
        least_cost: Compute units of the DAG's cheapest task.
    """

    def __init__(self, network: PlanningNetwork, least_cost: float) -> None:
        self.network = network
        self.timelines = [Timeline(least_cost / capacity) for capacity in network.capacities]
        self.mean_compute_s = cache(self._mean_compute_s)
        self.mean_transfer_s = cache(self._mean_transfer_s)
        self.mean_capacity = pairwise_sum(network.capacities) / len(network.capacities)

    @abstractmethod
    def earliest_finish(self, inputs: Inputs, cost: float) -> tuple[int, float]:
        """Return the position that finishes a task first, and when (s).

        Equals go to the lowest position. Where no finite time is found, position 0.
        """

    def earliest_finish_at(self, position: int, inputs: Inputs, cost: float) -> float:
        """Return when one node would finish a task (s)."""
        ready_s = self._ready_s(position, inputs)
        duration_s = cost / self.network.capacities[position]
        return self.timelines[position].earliest_finish_s(ready_s, duration_s)

    def book(self, position: int, finish_s: float, cost: float) -> None:
        """Book a task that ends at a time; like SAGA's, it begins its duration before."""
        duration_s = cost / self.network.capacities[position]
        self.timelines[position].book(finish_s - duration_s, finish_s)

    def _ready_s(self, position: int, inputs: Inputs) -> float:
        pair_speed_MBps = self.network.pair_speed_MBps
        ready_s = 0.0
        for source, end_s, size_MB in inputs:
            arrival_s = end_s + size_MB / pair_speed_MBps[source][position]
            ready_s = max(ready_s, arrival_s)
        return ready_s

    def _mean_compute_s(self, cost: float) -> float:
        return mean_quotient(cost, self.network.capacities)

    def _mean_transfer_s(self, size_MB: float) -> float:
        return mean_quotient(size_MB, self.network.link_speed_MBps)


class ListProcessors(Processors):
    """Asks node after node."""

    @override
    def earliest_finish(self, inputs: Inputs, cost: float) -> tuple[int, float]:
        rows = [
            (self.network.pair_speed_MBps[source], end_s, size_MB)
            for source, end_s, size_MB in inputs
        ]
        best, best_s = 0, math.inf
        for position, capacity in enumerate(self.network.capacities):
            ready_s = 0.0
            for speed_MBps, end_s, size_MB in rows:
                arrival_s = end_s + size_MB / speed_MBps[position]
                if arrival_s > ready_s:  # noqa: PLR1730  # max() doubles the planner's time
                    ready_s = arrival_s
            duration_s = cost / capacity
            if ready_s + duration_s < best_s:
                finish_s = self.timelines[position].earliest_finish_s(ready_s, duration_s)
                if finish_s < best_s:
                    best, best_s = position, finish_s
        return best, best_s
