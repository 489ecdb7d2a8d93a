"""The loop itself: events one after the other, until only Python can go on."""

from collections.abc import Callable
from enum import IntEnum
from pathlib import Path
from typing import Final, TypeAlias

from ncsim_core.compiling import inlined, kept_on_disk, state_of
from ncsim_core.engine.compiled.event_queue import find_due, remove_head
from ncsim_core.engine.compiled.log import has_room, log_event
from ncsim_core.engine.compiled.records import Record
from ncsim_core.engine.compiled.tasks import (
    complete_task,
    release_tasks,
    start_task,
    task_becomes_ready,
)
from ncsim_core.engine.compiled.transfers import complete_transfer, resume, start_transfer
from ncsim_core.engine.events import (
    DAG_INJECT,
    TASK_COMPLETE,
    TASK_READY,
    TASK_START,
    TRANSFER_COMPLETE,
)


class Stop(IntEnum):
    """Why the loop came back."""

    ENOUGH = 0
    """As many events as were asked for."""
    LOG_FULL = 1
    """Observers have to be told what happened first."""
    INJECTION = 2
    """The event is a DAG that enters; the scheduler has to be asked."""
    MISSING_SHARE = 3
    """A start or a finish waits for a share of the interference model."""
    NO_EVENT = 4
    """Nothing is left, or what is next goes beyond a limit."""
    WRONG_TASK = 5
    """A task starts on a node that is reserved for another."""


ENOUGH, LOG_FULL, INJECTION, MISSING_SHARE, NO_EVENT, WRONG_TASK = (int(stop) for stop in Stop)


@inlined
def handle(kind: int, number: int, state: Record) -> int:
    """Do what an event of any kind but an injection means; return why to stop, or ``ENOUGH``."""
    if kind == TASK_COMPLETE:
        complete_task(number, state)
    elif kind == TRANSFER_COMPLETE:
        if not complete_transfer(number, state):
            return MISSING_SHARE
    elif kind == TASK_READY:
        task_becomes_ready(number, state)
    elif kind == TASK_START:
        if not start_task(number, state):
            return WRONG_TASK
    elif not start_transfer(number, state):
        return MISSING_SHARE
    return ENOUGH


@inlined
def advance(count: int, state: Record) -> int:
    """Handle up to ``count`` events; return why no more of them."""
    for _ in range(count):
        if state.is_watched and not has_room(state):
            return LOG_FULL
        if not find_due(state):
            return NO_EVENT
        if not state.now_us <= state.due_us <= state.last_us or state.events >= state.max_events:
            return NO_EVENT
        remove_head(state)
        state.now_us = state.due_us
        state.events += 1
        if state.is_watched:
            log_event(state)
        if state.due_kind == DAG_INJECT:
            return INJECTION
        stop = handle(state.due_kind, state.due_number, state)
        if stop != ENOUGH:
            return stop
    return ENOUGH


@inlined
def enter(count: int, first: int, end: int, state: Record) -> int:
    """Do what had to wait for Python, then go on; arguments and answer as for the loop."""
    release_tasks(first, end, state)
    if state.is_stalled and not resume(state):
        return MISSING_SHARE
    stop = advance(count, state)
    state.is_stalled = stop == MISSING_SHARE
    return stop


Loop: TypeAlias = Callable[[int, int, int, Record], int]
"""Given how many events to handle at most and the first and the end of the tasks to release
before, says why it came back: a ``Stop``."""


def loop_of(sources: str) -> Loop:
    """Return the loop, compiled and kept on disk if numba is there.

    Args:
        sources: Stands for what it is compiled from; see ``state_of``.
    """

    def handle_events(count: int, first: int, end: int, state: Record) -> int:
        if not sources:
            return ENOUGH
        return enter(count, first, end, state)

    return kept_on_disk(handle_events)


def _sources() -> str:
    """Return what changes whenever a file does that the loop is compiled from."""
    here = Path(__file__).parent
    files = [*sorted(here.glob("*.py")), here.parent / "events.py", here.parents[1] / "units.py"]
    return state_of(files)


handle_events: Final = loop_of(_sources())
