"""Processors that ask all nodes at once, in numpy."""

from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from ncsim_saga.native.planning_network import PlanningNetwork
from ncsim_saga.native.processors import Inputs, Processors

FREE = -np.inf
"""End of a gap in a slot that is not in use: nothing fits."""

FEW_CANDIDATES = 24
"""Up to here, searching node by node is faster than searching all gaps at once."""


class ArrayProcessors(Processors):
    """Compares what nodes offer behind their last booking, then searches gaps where it may pay.

    Gaps are searched on the timelines of a few nodes, or in flat arrays that hold the gaps of
    all nodes in no particular order. Of two gaps of one node that both hold a task, the earlier
    one finishes it earlier, so the least finish over all gaps is SAGA's, which takes the first
    gap that fits.
    """

    def __init__(self, network: PlanningNetwork, least_cost: float) -> None:
        super().__init__(network, least_cost)
        count = len(network.capacities)
        self._capacities = np.array(network.capacities)
        self._pair_speed_MBps = np.array(network.pair_speed_MBps)
        self._free_from_s = np.zeros(count)
        self._owners = np.arange(count)
        self._begins_s = np.zeros(count)
        self._ends_s = np.full(count, np.inf)
        self._used = count
        self._unused: list[int] = []
        self._slots = [[position] for position in range(count)]

    @override
    def earliest_finish(self, inputs: Inputs, cost: float) -> tuple[int, float]:
        ready_s = self._ready_everywhere_s(inputs)
        durations_s = cost / self._capacities
        finishes_s = np.maximum(ready_s, self._free_from_s) + durations_s
        # A gap helps only a node that is booked beyond the task's readiness, and helps the task
        # only if even an immediate start there ends in time.
        may_be_sooner = ready_s + durations_s <= finishes_s.min()
        may_be_sooner &= ready_s < self._free_from_s
        candidates = may_be_sooner.nonzero()[0].tolist()
        if len(candidates) > FEW_CANDIDATES:
            return self._earliest_in_gaps(ready_s, durations_s)
        for position in candidates:
            finishes_s[position] = self.timelines[position].earliest_finish_s(
                float(ready_s[position]), float(durations_s[position])
            )
        best = int(finishes_s.argmin())
        return best, float(finishes_s[best])

    @override
    def book(self, position: int, finish_s: float, cost: float) -> None:
        timeline = self.timelines[position]
        duration_s = cost / self.network.capacities[position]
        gap, gone, come = timeline.book(finish_s - duration_s, finish_s)
        slots = self._slots[position]
        for slot in slots[gap : gap + gone]:
            self._ends_s[slot] = FREE
            self._unused.append(slot)
        fresh = [self._take_slot() for _ in range(come)]
        slots[gap : gap + gone] = fresh
        for offset, slot in enumerate(fresh):
            self._owners[slot] = position
            self._begins_s[slot] = timeline.gap_begins_s[gap + offset]
            self._ends_s[slot] = timeline.gap_ends_s[gap + offset]
        self._free_from_s[position] = timeline.gap_begins_s[-1]

    def _ready_everywhere_s(self, inputs: Inputs) -> NDArray[np.float64]:
        ready_s = np.zeros(len(self._capacities))
        for source, end_s, size_MB in inputs:
            arrivals_s = size_MB / self._pair_speed_MBps[source]
            arrivals_s += end_s
            np.maximum(ready_s, arrivals_s, out=ready_s)
        return ready_s

    def _earliest_in_gaps(
        self, ready_s: NDArray[np.float64], durations_s: NDArray[np.float64]
    ) -> tuple[int, float]:
        owners = self._owners[: self._used]
        finishes_s = np.maximum(ready_s[owners], self._begins_s[: self._used])
        finishes_s += durations_s[owners]
        finishes_s[finishes_s > self._ends_s[: self._used]] = np.inf
        best_s = finishes_s.min()
        return int(owners[finishes_s == best_s].min()), float(best_s)

    def _take_slot(self) -> int:
        if self._unused:
            return self._unused.pop()
        if self._used == len(self._owners):
            self._owners = np.concatenate([self._owners, np.zeros_like(self._owners)])
            self._begins_s = np.concatenate([self._begins_s, np.zeros_like(self._begins_s)])
            self._ends_s = np.concatenate([self._ends_s, np.full_like(self._ends_s, FREE)])
        self._used += 1
        return self._used - 1

    @override
    def _mean_compute_s(self, cost: float) -> float:
        return float(np.mean(cost / self._capacities))

    @override
    def _mean_transfer_s(self, size_MB: float) -> float:
        return float(np.mean(size_MB / self._link_speed_MBps))

    @cached_property
    def _link_speed_MBps(self) -> NDArray[np.float64]:
        return np.array(self.network.link_speed_MBps)
