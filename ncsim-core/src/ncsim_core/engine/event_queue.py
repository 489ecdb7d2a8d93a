"""The future: a heap ordered by time, kind, rank and insertion.

Entries are plain tuples of whole numbers, which compare and move far faster than objects.
"""

from heapq import heappop, heappush
from typing import TypeAlias

from ncsim_core.engine.events import TRANSFER_COMPLETE
from ncsim_core.units import Instant

Due: TypeAlias = tuple[Instant, int, int, int, int]
"""Time; kind of event; rank among events of the kind; ticket, the number of insertion, which breaks
what ties are left; number of the DAG, task or transfer. Smaller goes first."""


class EventQueue:
    """What is going to happen, first things first.

    Completions of transfers move often, mostly to later. A completion that is put off costs
    nothing until its entry, now too early, comes to the head and is put back where it belongs.
    """

    __slots__ = ("_completes_us", "_entered_us", "_heap", "_next_ticket")

    def __init__(self) -> None:
        self._heap: list[Due] = []
        self._next_ticket = 0
        self._completes_us: dict[int, Instant] = {}  # by transfer, unless it is paused
        self._entered_us: dict[int, Instant] = {}  # by transfer, the entry that counts

    def push(self, at_us: Instant, kind: int, number: int, rank: int = 0) -> None:
        """Add an event of any kind but the completion of a transfer."""
        ticket = self._next_ticket
        self._next_ticket = ticket + 1
        heappush(self._heap, (at_us, kind, rank, ticket, number))

    def complete_at(self, at_us: Instant, transfer: int, rank: int) -> None:
        """Let a transfer complete at a time, and at no other."""
        self._completes_us[transfer] = at_us
        entered_us = self._entered_us.get(transfer)
        if entered_us is None or at_us < entered_us:
            self._enter(at_us, transfer, rank)

    def pause(self, transfer: int) -> None:
        """Let a transfer not complete until something else is said."""
        self._completes_us.pop(transfer, None)

    def pop(self) -> Due | None:
        """Remove and return the next event, or ``None`` if nothing is left."""
        heap = self._heap
        while heap:
            due = heappop(heap)
            if due[1] != TRANSFER_COMPLETE or self._is_time(due):
                return due
        return None

    def _enter(self, at_us: Instant, transfer: int, rank: int) -> None:
        self._entered_us[transfer] = at_us
        self.push(at_us, TRANSFER_COMPLETE, transfer, rank)

    def _is_time(self, due: Due) -> bool:
        """Return whether a transfer completes now; if it does later, put its entry there."""
        at_us, _, rank, _, transfer = due
        if self._entered_us.get(transfer) != at_us:
            return False  # an earlier entry has taken its place
        completes_us = self._completes_us.get(transfer)
        if completes_us is not None and completes_us > at_us:
            self._enter(completes_us, transfer, rank)
            return False
        del self._entered_us[transfer]
        return self._completes_us.pop(transfer, None) is not None
