"""HEFT: the most urgent task first, where it finishes earliest, gaps included.

Source: https://doi.org/10.1109/71.993206, Section 4.1.
"""

from ncsim_saga.native.instance import Instance
from ncsim_saga.native.processors import Inputs, Processors
from ncsim_saga.native.ranks import by_urgency


def heft(instance: Instance, processors: Processors) -> list[int]:
    """Return the position of every task."""
    bookings = Bookings(instance, processors)
    for task in by_urgency(instance, processors):
        position, finish_s = processors.earliest_finish(
            bookings.inputs_of(task), instance.costs[task]
        )
        bookings.add(task, position, finish_s)
    return bookings.positions


class Bookings:
    """Where each task has been put, and when it ends."""

    def __init__(self, instance: Instance, processors: Processors) -> None:
        self._instance = instance
        self._processors = processors
        self._ends_s = [0.0] * len(instance.costs)
        self.positions = [0] * len(instance.costs)

    def inputs_of(self, task: int) -> Inputs:
        """Return where the inputs of a task come from; its parents must have been added."""
        return [
            (self.positions[parent], self._ends_s[parent], size_MB)
            for parent, size_MB in self._instance.parents[task]
        ]

    def add(self, task: int, position: int, finish_s: float) -> None:
        """Put a task on a node."""
        self.positions[task] = position
        self._ends_s[task] = finish_s
        self._processors.book(position, finish_s, self._instance.costs[task])
