"""What a trace has told so far about tasks, and what may not follow from it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from ncsim_core.trace.records import Ended, Injected, Placed, Ready, Started, TracePreamble
from ncsim_core.units import us_from_s

Find: TypeAlias = Callable[[str], None]
"""Takes what is wrong with the record that is being looked at."""


@dataclass
class TaskEntry:
    """A task as far as the trace has told."""

    name: str
    cost: float
    injected_us: int
    node: int | None = None
    missing: int = 0
    arrived_us: int = 0
    ready_us: int | None = None
    started_us: int | None = None
    ended_us: int | None = None


class TaskLedger:
    """Follows tasks through their lives.

    Args:
        preamble: The nodes.
        find: Takes what is wrong.
    """

    def __init__(self, preamble: TracePreamble, find: Find) -> None:
        self._nodes = preamble.nodes
        self._find = find
        self._running: dict[int, int] = {}
        self.entries: list[TaskEntry] = []
        self.last_end_us: int | None = None

    def inject(self, record: Injected) -> None:
        """Enter the tasks of a DAG."""
        self.entries += [
            TaskEntry(name, cost, record.at_us, arrived_us=record.at_us)
            for name, cost in record.tasks
        ]
        for _, target, _ in record.edges:
            if target < len(self.entries):
                self.entries[target].missing += 1

    def place(self, record: Placed, dag: Injected) -> None:
        """Enter the nodes of a DAG's tasks."""
        if len(record.nodes) != len(dag.tasks):
            self._find(f"{len(record.nodes)} nodes are given for {len(dag.tasks)} tasks")
        first = dag.first_task
        for entry, node in zip(self.entries[first:], record.nodes, strict=False):
            entry.node = node

    def arrive(self, task: int, at_us: int) -> None:
        """Enter that one input of a task is there."""
        entry = self.entries[task]
        entry.missing -= 1
        entry.arrived_us = max(entry.arrived_us, at_us)

    def ready(self, record: Ready) -> None:
        """Check and enter that a task is ready."""
        entry = self._expect_its_node(record)
        if entry.ready_us is not None:
            self._find(f"task {entry.name!r} is ready a second time")
        if entry.missing:
            self._find(f"task {entry.name!r} is ready, but {entry.missing} inputs are not there")
        elif record.at_us != entry.arrived_us:
            self._find(f"task {entry.name!r} had all its inputs at {entry.arrived_us} us")
        entry.ready_us = record.at_us

    def start(self, record: Started) -> None:
        """Check and enter that a task runs."""
        entry = self._expect_its_node(record)
        if entry.ready_us is None:
            self._find(f"task {entry.name!r} starts before it is ready")
        if entry.started_us is not None:
            self._find(f"task {entry.name!r} starts a second time")
        other = self._running.get(record.node)
        if other is not None:
            node = self._nodes[record.node].id
            self._find(
                f"task {entry.name!r} starts while {self.entries[other].name!r} runs on {node!r}"
            )
        self._running[record.node] = record.task
        entry.started_us = record.at_us

    def end(self, record: Ended) -> None:
        """Check and enter that a task has ended."""
        entry = self._expect_its_node(record)
        if entry.ended_us is not None:
            self._find(f"task {entry.name!r} ends a second time")
        if entry.started_us is None:
            self._find(f"task {entry.name!r} ends without having started")
        else:
            due_us = us_from_s(entry.cost / self._nodes[record.node].capacity)
            if record.at_us - entry.started_us != due_us:
                ran_us = record.at_us - entry.started_us
                self._find(f"task {entry.name!r} ran for {ran_us} us instead of {due_us}")
        if self._running.get(record.node) == record.task:
            del self._running[record.node]
        entry.ended_us = self.last_end_us = record.at_us

    def expect_all_ended(self) -> None:
        """Check that no task is left."""
        for entry in self.entries:
            if entry.ended_us is None:
                self._find(f"the run is completed, but task {entry.name!r} has not ended")

    def _expect_its_node(self, record: Ready | Started | Ended) -> TaskEntry:
        entry = self.entries[record.task]
        if entry.node != record.node:
            self._find(
                f"task {entry.name!r} is on node {record.node}, but was placed on {entry.node}"
            )
        return entry
