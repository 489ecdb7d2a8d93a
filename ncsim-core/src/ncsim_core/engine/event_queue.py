"""The future: a heap ordered by time, kind and place among events of the kind.

Entries are plain tuples of whole numbers, which compare and move far faster than objects.
"""

from __future__ import annotations

from heapq import heappop, heappush
from typing import TYPE_CHECKING, TypeAlias

from ncsim_core.engine.events import TRANSFER_COMPLETE, TRANSFER_START
from ncsim_core.units import Instant, NEVER_us

if TYPE_CHECKING:
    from ncsim_core.engine.state import Transfer

Due: TypeAlias = tuple[Instant, int, int, int]
"""Time; kind of event; place among events of the kind, which is the rank of a transfer and for all
else the order of insertion; number of the DAG, task or transfer. Smaller goes first."""


class EventQueue:
    """What is going to happen, first things first.

    Completions of transfers move often, mostly to later. A completion that is put off costs
    nothing until its entry, now too early, comes to the head and is put back where it belongs.

    Most events are due at the very instant at which they come up. They have a heap of their own,
    which is almost empty: in the other they would pass everything that is still to come.

    Args:
        transfers: By number; they know when they complete.
        soon: Events that are due at the instant at which they were added.
        later: All others.
    """

    __slots__ = ("_next_ticket", "_transfers", "later", "soon")

    def __init__(self, transfers: dict[int, Transfer]) -> None:
        self.soon: list[Due] = []
        self.later: list[Due] = []
        self._transfers = transfers
        self._next_ticket = 0

    def push(self, at_us: Instant, kind: int, number: int) -> None:
        """Add an event of a DAG or a task, after those of its time and kind."""
        ticket = self._next_ticket
        self._next_ticket = ticket + 1
        heappush(self.later, (at_us, kind, ticket, number))

    def push_soon(self, now_us: Instant, kind: int, number: int) -> None:
        """Add an event of a task that is due now, after those of its kind."""
        ticket = self._next_ticket
        self._next_ticket = ticket + 1
        heappush(self.soon, (now_us, kind, ticket, number))

    def start_at(self, at_us: Instant, transfer: Transfer) -> None:
        """Let the byte service of a transfer begin at a time."""
        heappush(self.later, (at_us, TRANSFER_START, transfer.rank, transfer.number))

    def start_soon(self, now_us: Instant, transfer: Transfer) -> None:
        """Let the byte service of a transfer begin now, after all else that is due now."""
        heappush(self.soon, (now_us, TRANSFER_START, transfer.rank, transfer.number))

    def enter(self, transfer: Transfer) -> None:
        """Add the completion of a transfer, needed if it has none or one that is too late."""
        transfer.entered_us = transfer.completes_us
        entry = (transfer.completes_us, TRANSFER_COMPLETE, transfer.rank, transfer.number)
        heappush(self.later, entry)

    def pop(self) -> Due | None:
        """Remove and return the next event, or ``None`` if nothing is left."""
        soon, later = self.soon, self.later
        while soon or later:
            due = heappop(soon if soon and not (later and later[0] < soon[0]) else later)
            if due[1] != TRANSFER_COMPLETE or self.is_time(due):
                return due
        return None

    def next_start(self, now_us: Instant) -> int | None:
        """Return the transfer that starts next, at this instant; ``None`` if none does."""
        soon, later = self.soon, self.later
        head = soon[0] if soon else None
        if later and (head is None or later[0] < head):
            head = later[0]
        is_one = head is not None and head[0] == now_us and head[1] == TRANSFER_START
        return head[3] if is_one and head is not None else None

    def is_time(self, due: Due) -> bool:
        """Return whether a transfer completes now; if it does later, put its entry there."""
        at_us = due[0]
        transfer = self._transfers[due[3]]
        if transfer.entered_us != at_us:
            return False  # an earlier entry has taken its place
        transfer.entered_us = NEVER_us
        if transfer.completes_us == at_us:
            return True
        if transfer.completes_us < NEVER_us:
            self.enter(transfer)
        return False
