"""The six things that can happen, in the order in which they happen at one instant.

Completions come before starts, and task completions before transfer completions, so that a
freed node is available to whatever becomes ready at the same instant (paper, Section V-A).
"""

from enum import IntEnum
from typing import Final, NamedTuple

from ncsim_core.units import Instant


class EventKind(IntEnum):
    """What happens; the value is its place among what happens at one instant."""

    DAG_INJECT = 0
    """A DAG enters: plan it, and release its first tasks."""
    TASK_COMPLETE = 1
    """A task ends: free its node and send its results."""
    TRANSFER_COMPLETE = 2
    """The last byte arrives: free the route and tell the waiting task."""
    TASK_READY = 3
    """All inputs are there: run the task, or queue it if its node is busy."""
    TASK_START = 4
    """A task begins on the node that was reserved for it."""
    TRANSFER_START = 5
    """Latency is paid: occupy the route and begin byte service."""


# The same as plain numbers: they are used millions of times, and a member is slow to look up.
DAG_INJECT: Final = int(EventKind.DAG_INJECT)
TASK_COMPLETE: Final = int(EventKind.TASK_COMPLETE)
TRANSFER_COMPLETE: Final = int(EventKind.TRANSFER_COMPLETE)
TASK_READY: Final = int(EventKind.TASK_READY)
TASK_START: Final = int(EventKind.TASK_START)
TRANSFER_START: Final = int(EventKind.TRANSFER_START)


class Event(NamedTuple):
    """Something that has happened.

    Args:
        at_us: When.
        kind: What.
        number: Of the DAG, the task or the transfer.
    """

    at_us: Instant
    kind: EventKind
    number: int
