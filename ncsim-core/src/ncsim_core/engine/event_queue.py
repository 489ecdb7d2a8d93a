"""The future: a heap ordered by time, kind, rank and insertion.

Entries are plain tuples of whole numbers, which compare and move far faster than objects.
"""

from heapq import heappop, heappush
from typing import TypeAlias

from ncsim_core.units import Instant

Due: TypeAlias = tuple[Instant, int, int, int, int]
"""Time; kind of event; rank among events of the kind; ticket, the number of insertion, which breaks
what ties are left; number of the DAG, task or transfer. Smaller goes first."""


class EventQueue:
    """A priority queue whose entries can be cancelled.

    Cancelling is lazy: a stale entry stays in the heap until it reaches the head.
    """

    __slots__ = ("_cancelled", "_heap", "_next_ticket")

    def __init__(self) -> None:
        self._heap: list[Due] = []
        self._cancelled: set[int] = set()
        self._next_ticket = 0

    def __len__(self) -> int:
        return len(self._heap) - len(self._cancelled)

    def push(self, at_us: Instant, kind: int, number: int, rank: int = 0) -> int:
        """Add an event; return the ticket that cancels it."""
        ticket = self._next_ticket
        self._next_ticket = ticket + 1
        heappush(self._heap, (at_us, kind, rank, ticket, number))
        return ticket

    def cancel(self, ticket: int) -> None:
        """Take back an event that has not happened yet."""
        self._cancelled.add(ticket)

    def pop(self) -> Due | None:
        """Remove and return the next event, or ``None`` if nothing is left."""
        heap, cancelled = self._heap, self._cancelled
        while heap:
            due = heappop(heap)
            if due[3] not in cancelled:
                return due
            cancelled.remove(due[3])
        return None
