"""One run in the compiled loop, and what Python has to do in between."""

from typing import Final

from ncsim_core.engine.boundary import asked
from ncsim_core.engine.compiled import loop
from ncsim_core.engine.compiled.arrays import Arrays
from ncsim_core.engine.compiled.loading import loaded, place
from ncsim_core.engine.compiled.radio_loading import Radio
from ncsim_core.engine.compiled.telling import Teller
from ncsim_core.engine.compiled.unloading import under_way, unload, unload_counts
from ncsim_core.engine.event_queue import Due
from ncsim_core.engine.sessions.choice import loads_of
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import State
from ncsim_core.engine.tasks import place_dag, snapshot_of
from ncsim_core.errors import EngineError
from ncsim_core.units import Instant

GREATEST: Final = 2**63 - 1


class CompiledRun:
    """A run whose events are handled by the compiled loop.

    Args:
        state: Of the run before its first event; brought up to date by ``unload``.
        setup: Of the run.
        last_us: No event after this is handled.

    Attributes:
        due: The event handled last, or the one that was not; ``None`` if nothing is left.
    """

    def __init__(self, state: State, setup: Setup, last_us: Instant) -> None:
        self.due: Due | None = None
        self._state = state
        self._setup = setup
        self._arrays: Arrays = loaded(setup)
        record = self._arrays.state
        record.last_us = last_us
        max_events = setup.limits.max_events
        record.max_events = GREATEST if max_events is None else min(max_events, GREATEST)
        tables = setup.models.interference.tables()
        self._radio = None if tables is None else Radio(loads_of(tables), self._arrays)
        self._teller = Teller(self._arrays, state, tables)
        self._to_release = (0, 0)

    def advance(self, count: int) -> bool:
        """Handle up to ``count`` events; return whether there may be more.

        Raises:
            NcsimError: A component failed.
            EngineError: The engine broke one of its own invariants.
        """
        record = self._arrays.state
        until = int(record.events) + count
        stop = None
        while stop not in (loop.ENOUGH, loop.NO_EVENT) and not self._state.unroutable:
            (first, end), self._to_release = self._to_release, (0, 0)
            stop = loop.handle_events(until - int(record.events), first, end, record)
            self._help(stop)
        self.catch_up()
        self._note_due(is_none=stop == loop.NO_EVENT and record.entries == 0)
        return stop != loop.NO_EVENT

    def _help(self, stop: int) -> None:
        """Do what the loop has stopped for."""
        if stop == loop.INJECTION:
            self._inject()
        elif stop == loop.MISSING_SHARE:
            self._fill_missing_share()
        elif stop == loop.LOG_FULL:
            self._teller.tell()
        elif stop == loop.WRONG_TASK:
            task = self._arrays.state.due_number
            raise EngineError(f"task {task} starts on a node reserved for another")

    def _inject(self) -> None:
        """Plan the DAG that enters; its tasks are released when the loop goes on."""
        self.catch_up()
        number, state, setup = int(self._arrays.state.due_number), self._state, self._setup
        nodes = self._arrays["nodes"]
        depths = (nodes.waiting + (nodes.task >= 0)).tolist()
        seen = snapshot_of(depths, under_way(self._arrays, state, setup), state, setup)
        place_dag(number, seen, state, setup)
        if not state.unroutable:
            first = setup.first_task[number]
            end = first + len(setup.injections[number].dag.tasks)
            place(number, [run.node for run in state.tasks[first:end]], setup, self._arrays)
            self._to_release = (first, end)

    def _fill_missing_share(self) -> None:
        assert self._radio is not None  # without one no share is asked for
        try:
            asked(self._setup.models.identity("interference_model"), self._radio.fill_missing_share)
        except Exception:
            self.catch_up()
            raise

    def catch_up(self) -> None:
        """Tell observers what they do not know, and bring what is one number up to date."""
        self._teller.tell()
        unload_counts(self._arrays, self._state)

    def unload(self) -> None:
        """Bring the whole state up to date."""
        unload(self._arrays, self._state, self._setup)

    def _note_due(self, *, is_none: bool) -> None:
        record = self._arrays.state
        due = int(record.due_us), int(record.due_kind), 0, int(record.due_number)
        self.due = None if is_none else due
