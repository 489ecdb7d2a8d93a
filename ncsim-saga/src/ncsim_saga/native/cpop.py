"""CPOP: the critical path on one node, every other task where it finishes earliest.

Source: https://doi.org/10.1109/71.993206, Section 4.2.
"""

import heapq

from ncsim_saga.native.heft import Bookings
from ncsim_saga.native.instance import Instance
from ncsim_saga.native.processors import Processors
from ncsim_saga.native.ranks import exact_downward_ranks, exact_upward_ranks

CLOSE_ABSOLUTE_s = 1e-8  # numpy.isclose's defaults, by which SAGA tells critical tasks
CLOSE_RELATIVE = 1e-5


def cpop(instance: Instance, processors: Processors) -> list[int]:
    """Return the position of every task."""
    ups_s = exact_upward_ranks(instance, processors)
    downs_s = exact_downward_ranks(instance, processors)
    ranks_s = [up_s + down_s for up_s, down_s in zip(ups_s, downs_s, strict=True)]
    critical = _critical_tasks(ranks_s, instance)
    critical_node = _critical_node(critical, instance, processors)
    bookings = Bookings(instance, processors)
    ready = _Ready(ranks_s, instance)
    while (task := ready.pop()) is not None:
        inputs, cost = bookings.inputs_of(task), instance.costs[task]
        if task in critical:
            position = critical_node
            finish_s = processors.earliest_finish_at(position, inputs, cost)
        else:
            position, finish_s = processors.earliest_finish(inputs, cost)
        bookings.add(task, position, finish_s)
    return bookings.positions


def _critical_tasks(ranks_s: list[float], instance: Instance) -> dict[int, None]:
    """Return the tasks whose rank is close to that of the first task, in SAGA's order."""
    length_s = max(ranks_s[task] for task in instance.walk if not instance.parents[task])
    tolerance_s = CLOSE_ABSOLUTE_s + CLOSE_RELATIVE * abs(length_s)
    return {task: None for task in instance.walk if abs(ranks_s[task] - length_s) <= tolerance_s}


def _critical_node(critical: dict[int, None], instance: Instance, processors: Processors) -> int:
    """Return the position that runs all critical tasks in the least time.

    The built-in ``sum`` on purpose: SAGA uses it, and how it rounds depends on the Python.
    """
    costs = [instance.costs[task] for task in critical]
    capacities = processors.network.capacities
    return min(
        range(len(capacities)),
        key=lambda position: sum(cost / capacities[position] for cost in costs),
    )


class _Ready:
    """Tasks whose parents have been placed; the highest rank goes first, then the lowest name."""

    def __init__(self, ranks_s: list[float], instance: Instance) -> None:
        self._ranks_s = ranks_s
        self._instance = instance
        self._unmet = [len(parents) for parents in instance.parents]
        self._heap: list[tuple[float, str, int]] = []
        for task in instance.walk:
            if self._unmet[task] == 0:
                self._push(task)

    def pop(self) -> int | None:
        """Return the next task, which counts as placed from now on; ``None`` at the end."""
        if not self._heap:
            return None
        task = heapq.heappop(self._heap)[2]
        for child, _ in self._instance.children[task]:
            self._unmet[child] -= 1
            if self._unmet[child] == 0:
                self._push(child)
        return task

    def _push(self, task: int) -> None:
        heapq.heappush(self._heap, (-self._ranks_s[task], self._instance.names[task], task))
