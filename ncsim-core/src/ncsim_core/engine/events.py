"""The six things that can happen, in the order in which they happen at one instant.

Completions come before starts, and task completions before transfer completions, so that a
freed node is available to whatever becomes ready at the same instant (paper, Section V-A).
"""

from dataclasses import dataclass
from typing import ClassVar, TypeAlias

from ncsim_core.engine.state import TaskRun, Transfer


@dataclass(frozen=True, slots=True)
class DagInject:
    """A DAG enters: plan it, and release its first tasks."""

    priority: ClassVar[int] = 0
    dag: int


@dataclass(frozen=True, slots=True)
class TaskComplete:
    """A task ends: free its node and send its results."""

    priority: ClassVar[int] = 1
    task: TaskRun


@dataclass(frozen=True, slots=True)
class TransferComplete:
    """The last byte arrives: free the route and tell the waiting task."""

    priority: ClassVar[int] = 2
    transfer: Transfer


@dataclass(frozen=True, slots=True)
class TaskReady:
    """All inputs are there: run the task, or queue it if its node is busy."""

    priority: ClassVar[int] = 3
    task: TaskRun


@dataclass(frozen=True, slots=True)
class TaskStart:
    """A task begins on the node that was reserved for it."""

    priority: ClassVar[int] = 4
    task: TaskRun


@dataclass(frozen=True, slots=True)
class TransferStart:
    """Latency is paid: occupy the route and begin byte service."""

    priority: ClassVar[int] = 5
    transfer: Transfer


Event: TypeAlias = (
    DagInject | TaskComplete | TransferComplete | TaskReady | TaskStart | TransferStart
)
