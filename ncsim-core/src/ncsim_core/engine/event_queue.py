"""The future: a heap ordered by time, priority, rank and insertion."""

import heapq
from typing import Generic, NamedTuple, TypeVar

from ncsim_core.units import Instant

E = TypeVar("E")


class Due(NamedTuple, Generic[E]):
    """An event and when it happens.

    Args:
        at_us: Time.
        priority: Smaller goes first at one time.
        rank: Smaller goes first at one time and priority.
        ticket: Number of insertion; breaks what ties are left.
        event: What happens.
    """

    at_us: Instant
    priority: int
    rank: int
    ticket: int
    event: E


class EventQueue(Generic[E]):
    """A priority queue whose entries can be cancelled.

    Cancelling is lazy: a stale entry stays in the heap until it reaches the head.
    """

    def __init__(self) -> None:
        self._heap: list[Due[E]] = []
        self._cancelled: set[int] = set()
        self._next_ticket = 0

    def __len__(self) -> int:
        return len(self._heap) - len(self._cancelled)

    def push(self, at_us: Instant, priority: int, event: E, rank: int = 0) -> int:
        """Add an event; return the ticket that cancels it."""
        ticket = self._next_ticket
        self._next_ticket = ticket + 1
        heapq.heappush(self._heap, Due(at_us, priority, rank, ticket, event))
        return ticket

    def cancel(self, ticket: int) -> None:
        """Take back an event that has not happened yet."""
        self._cancelled.add(ticket)

    def peek(self) -> Due[E] | None:
        """Return the next event without removing it, or ``None`` if nothing is left."""
        heap, cancelled = self._heap, self._cancelled
        while heap:
            head = heap[0]
            if head.ticket not in cancelled:
                return head
            cancelled.remove(head.ticket)
            heapq.heappop(heap)
        return None

    def pop(self) -> Due[E] | None:
        """Remove and return the next event, or ``None`` if nothing is left."""
        due = self.peek()
        if due is not None:
            heapq.heappop(self._heap)
        return due
