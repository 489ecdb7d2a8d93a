"""The future: a heap ordered by time, kind, and rank or ticket.

The engine orders by rank and then by ticket. Transfers have ranks of their own and everything else
has rank 0, so here one number is enough. A transfer's completion has one entry at most; put off, it
stays where it is until it comes to the head, and brought forward, it rises.
"""

from typing import Final

from ncsim_core.compiling import inlined
from ncsim_core.engine.compiled.layout import NONE, entry_at, transfer_at
from ncsim_core.engine.compiled.records import Record
from ncsim_core.engine.events import TRANSFER_COMPLETE
from ncsim_core.units import Instant, NEVER_us

KIND_SHIFT: Final = 48  # more ranks and tickets than any run has


@inlined
def push(at_us: Instant, kind: int, number: int, state: Record) -> None:
    """Add an event of a DAG or a task."""
    order = (kind << KIND_SHIFT) + state.tickets
    state.tickets += 1
    state.entries += 1
    rise(state.entries - 1, at_us, order, number, state)


@inlined
def push_transfer(at_us: Instant, kind: int, number: int, state: Record) -> None:
    """Add an event of a transfer."""
    order = (kind << KIND_SHIFT) + transfer_at(number, state).rank
    state.entries += 1
    rise(state.entries - 1, at_us, order, number, state)


@inlined
def complete_at(at_us: Instant, number: int, state: Record) -> None:
    """Let a transfer complete at a time, and at no other; ``NEVER_us`` pauses it."""
    transfer = transfer_at(number, state)
    transfer.completes_us = at_us
    if transfer.place == NONE:
        if at_us < NEVER_us:
            push_transfer(at_us, TRANSFER_COMPLETE, number, state)
    elif at_us < entry_at(transfer.place, state).at_us:
        rise(transfer.place, at_us, entry_at(transfer.place, state).order, number, state)


@inlined
def find_due(state: Record) -> bool:
    """Put what is next into the clock; return whether anything is left."""
    while state.entries > 0:
        head = entry_at(0, state)
        at_us, number = head.at_us, head.number
        kind = head.order >> KIND_SHIFT
        if kind != TRANSFER_COMPLETE or transfer_at(number, state).completes_us == at_us:
            state.due_us, state.due_kind, state.due_number = at_us, kind, number
            return True
        if transfer_at(number, state).completes_us == NEVER_us:
            remove_head(state)
        else:  # it has been put off
            sink(transfer_at(number, state).completes_us, head.order, number, state)
    return False


@inlined
def remove_head(state: Record) -> None:
    """Take what is next off the queue."""
    if entry_at(0, state).order >> KIND_SHIFT == TRANSFER_COMPLETE:
        transfer = transfer_at(entry_at(0, state).number, state)
        transfer.place, transfer.completes_us = NONE, NEVER_us
    state.entries -= 1
    last = entry_at(state.entries, state)
    if state.entries > 0:
        sink(last.at_us, last.order, last.number, state)


@inlined
def rise(place: int, at_us: Instant, order: int, number: int, state: Record) -> None:
    """Put an entry where it belongs, at a place or above."""
    while place > 0:
        above = (place - 1) >> 1
        other = entry_at(above, state)
        if other.at_us < at_us or (other.at_us == at_us and other.order < order):
            break
        settle(place, other.at_us, other.order, other.number, state)
        place = above
    settle(place, at_us, order, number, state)


@inlined
def sink(at_us: Instant, order: int, number: int, state: Record) -> None:
    """Put an entry where it belongs, at the head or below."""
    entries = state.entries
    place, below = 0, 1
    while below < entries:
        if below + 1 < entries and is_before(entry_at(below + 1, state), entry_at(below, state)):
            below += 1
        other = entry_at(below, state)
        if at_us < other.at_us or (at_us == other.at_us and order < other.order):
            break
        settle(place, other.at_us, other.order, other.number, state)
        place, below = below, 2 * below + 1
    settle(place, at_us, order, number, state)


@inlined
def is_before(one: Record, other: Record) -> bool:
    """Return whether one entry goes before another."""
    earlier: bool = one.at_us < other.at_us
    return earlier or (one.at_us == other.at_us and one.order < other.order)


@inlined
def settle(place: int, at_us: Instant, order: int, number: int, state: Record) -> None:
    """Write an entry."""
    entry = entry_at(place, state)
    entry.at_us, entry.order, entry.number = at_us, order, number
    if order >> KIND_SHIFT == TRANSFER_COMPLETE:
        transfer_at(number, state).place = place
