"""Processors that ask all nodes at once, in numpy."""

from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from ncsim_saga.native.means import ArrayMeanQuotient
from ncsim_saga.native.planning_network import PlanningNetwork
from ncsim_saga.native.processors import Inputs, Processors

FREE = -np.inf
"""End of a gap in a slot that is not in use: nothing fits."""


class ArrayProcessors(Processors):
    """Keeps the gaps of all nodes in flat arrays, in no particular order.

    Of two gaps of one node that both hold a task, the earlier one finishes it earlier, so the least
    finish over all gaps is SAGA's, which takes the first gap that fits.
    """

    def __init__(self, network: PlanningNetwork, least_cost: float) -> None:
        super().__init__(network, least_cost)
        count = len(network.capacities)
        self._capacities = np.array(network.capacities)
        self._pair_speed_MBps = np.array(network.pair_speed_MBps)
        self._owners = np.arange(count)
        self._begins_s = np.zeros(count)
        self._ends_s = np.full(count, np.inf)
        self._used = count
        self._free: list[int] = []
        self._slots = [[position] for position in range(count)]

    @override
    def earliest_finish(self, inputs: Inputs, cost: float) -> tuple[int, float]:
        durations_s = cost / self._capacities
        owners = self._owners[: self._used]
        begins_s = np.maximum(self._all_ready_s(inputs)[owners], self._begins_s[: self._used])
        finishes_s = begins_s + durations_s[owners]
        finishes_s[finishes_s > self._ends_s[: self._used]] = np.inf
        best_s = finishes_s.min()
        if best_s == np.inf:
            return 0, float(best_s)
        return int(owners[finishes_s == best_s].min()), float(best_s)

    @override
    def book(self, position: int, finish_s: float, cost: float) -> None:
        timeline = self.timelines[position]
        duration_s = cost / self.network.capacities[position]
        gap, gone, come = timeline.book(finish_s - duration_s, finish_s)
        slots = self._slots[position]
        for slot in slots[gap : gap + gone]:
            self._ends_s[slot] = FREE
            self._free.append(slot)
        fresh = [self._free_slot() for _ in range(come)]
        slots[gap : gap + gone] = fresh
        for offset, slot in enumerate(fresh):
            self._owners[slot] = position
            self._begins_s[slot] = timeline.gap_begins_s[gap + offset]
            self._ends_s[slot] = timeline.gap_ends_s[gap + offset]

    def _all_ready_s(self, inputs: Inputs) -> NDArray[np.float64]:
        ready_s = np.zeros(len(self._capacities))
        for source, end_s, size_MB in inputs:
            arrivals_s = size_MB / self._pair_speed_MBps[source]
            arrivals_s += end_s
            np.maximum(ready_s, arrivals_s, out=ready_s)
        return ready_s

    def _free_slot(self) -> int:
        if self._free:
            return self._free.pop()
        if self._used == len(self._owners):
            self._owners = np.concatenate([self._owners, np.zeros_like(self._owners)])
            self._begins_s = np.concatenate([self._begins_s, np.zeros_like(self._begins_s)])
            self._ends_s = np.concatenate([self._ends_s, np.full_like(self._ends_s, FREE)])
        self._used += 1
        return self._used - 1

    @cached_property
    def _mean_over_links(self) -> ArrayMeanQuotient:
        return ArrayMeanQuotient(np.array(self.network.link_speed_MBps))

    @override
    def _mean_transfer_s(self, size_MB: float) -> float:
        return self._mean_over_links(size_MB)
