"""One run: take the next event, handle it, until nothing is left or a reason to stop appears."""

import math
import time
from collections.abc import Callable, Iterable
from heapq import heappop
from typing import TYPE_CHECKING, Final, TypeAlias, assert_never

from ncsim_core.engine.event_queue import Due
from ncsim_core.engine.events import DAG_INJECT, TRANSFER_COMPLETE, Event, EventKind
from ncsim_core.engine.log import Log
from ncsim_core.engine.looping import compiled_run_of
from ncsim_core.engine.observer import BatchObserver, Observer, Watcher
from ncsim_core.engine.outcome import Outcome, RunStatus
from ncsim_core.engine.setup import Limits, Reach, Setup
from ncsim_core.engine.state import State
from ncsim_core.engine.tasks import (
    complete_task,
    inject_dag,
    start_task,
    task_becomes_ready,
)
from ncsim_core.engine.transfers import complete_transfer, start_transfer
from ncsim_core.errors import EngineError, NcsimError, some_of
from ncsim_core.models import Models
from ncsim_core.network import Network
from ncsim_core.units import HORIZON_us, s_from_us

if TYPE_CHECKING:
    from ncsim_core.engine.compiled.compiled_run import CompiledRun

MAX_LINES_IN_DETAIL = 20
MAX_LINKS_IN_DETAIL = 5

MOST_AT_A_TIME = 1000
"""Events between two looks at the clock and two batches for those who watch."""

LAG_s = 0.1
"""About how long these may take."""

Handler: TypeAlias = Callable[[int, State, Setup], None]
"""Does what an event of one kind means, given the number of its DAG, task or transfer."""


def handler_of(kind: EventKind) -> Handler:
    """Return what handles events of a kind; mypy fails until every kind has one."""
    match kind:
        case EventKind.DAG_INJECT:
            return inject_dag
        case EventKind.TASK_COMPLETE:
            return complete_task
        case EventKind.TRANSFER_COMPLETE:
            return complete_transfer
        case EventKind.TASK_READY:
            return task_becomes_ready
        case EventKind.TASK_START:
            return start_task
        case EventKind.TRANSFER_START:
            return start_transfer
        case _:
            assert_never(kind)


HANDLERS: Final = tuple(handler_of(kind) for kind in EventKind)
"""By kind; looked up for every event, where a ``match`` would take a microsecond."""


class Simulation:
    """A run that can be stepped, watched and asked.

    Args:
        network: Nodes and links, rates decided.
        models: The six components.
        limits: When to give up.
        observers: Who watches, from the first event on.
        reach: How far a refresh looks; ``Reach.GLOBAL`` is the slow oracle of the tests.

    Raises:
        PluginError: The DAG source's injections are out of order or ambiguous, or the interference
            model's tables contradict themselves.
    """

    def __init__(
        self,
        network: Network,
        models: Models,
        limits: Limits | None = None,
        observers: Iterable[Watcher] = (),
        *,
        reach: Reach = Reach.LOCAL,
    ) -> None:
        self.setup = Setup.of(network, models, limits or Limits(), reach)
        self._state = State.of(self.setup)
        self._compiled: CompiledRun | None = None
        self._is_behind = False
        self._noted: list[Due] | None = None  # events in the state's log
        self.outcome: Outcome | None = None
        chosen = self.setup.limits
        self._max_events = math.inf if chosen.max_events is None else chosen.max_events
        self._last_us = HORIZON_us
        if chosen.max_time_us is not None:
            self._last_us = min(HORIZON_us, chosen.max_time_us)
        for number, injection in enumerate(self.setup.injections):
            self._state.queue.push(injection.at_us, DAG_INJECT, number)
        for observer in observers:
            self.observe(observer)

    @property
    def state(self) -> State:
        """Return everything about the run that changes, as of now."""
        if self._compiled is not None and self._is_behind:
            self._is_behind = False
            self._compiled.unload()
        return self._state

    def observe(self, watcher: Watcher) -> None:
        """Let somebody watch the rest of the run.

        Raises:
            ValueError: The first event has been handled already.
        """
        state = self._state
        if state.events or self.outcome is not None:
            raise ValueError("observers must be added before the first event is handled")
        state.watchers += (watcher,)
        if isinstance(watcher, Observer):
            state.observers += (watcher,)
        elif isinstance(watcher, BatchObserver):
            state.log = Log((*(state.log.observers if state.log else ()), watcher))
            self._noted = state.log.events
        state.shows_rates |= watcher.wants_rates
        watcher.run_started(self.setup)

    def run(self) -> Outcome:
        """Run to the end, and return how it was."""
        if self._compiled is None and not self._state.events and self.outcome is None:
            self._compiled = compiled_run_of(self._state, self.setup, self._last_us)
        if self._compiled is None:
            self.run_until(math.inf)
        while self.outcome is None:
            self._advance(MOST_AT_A_TIME)
        return self.outcome

    def run_until(self, deadline_s: float) -> Outcome | None:
        """Run until the end or shortly after a time on the clock; return how it ended, if it did.

        Args:
            deadline_s: As ``time.monotonic`` counts.
        """
        count = 1
        began_s = time.monotonic()
        while self.outcome is None and began_s < deadline_s:
            self._advance(count)
            now_s = time.monotonic()
            if now_s - began_s > LAG_s:
                count = max(1, count // 2)
            elif now_s - began_s < LAG_s / 2:
                count = min(2 * count, MOST_AT_A_TIME)
            began_s = now_s
        return self.outcome

    def step(self) -> Event | None:
        """Handle the next event and return it; ``None`` once the run has ended.

        What goes wrong in a component ends the run with status ``failed``.

        Raises:
            EngineError: The engine broke one of its own invariants.
        """
        if self.outcome is not None:
            return None
        due = self._advance(1)
        return None if due is None else Event(due[0], EventKind(due[1]), due[3])

    def _advance(self, count: int) -> Due | None:
        """Handle up to ``count`` events and return the last, ``None`` if the run ended instead."""
        try:
            due = self._handle_some(count)
            self._tell()
        except EngineError:
            raise
        except NcsimError as error:
            self._end(RunStatus.FAILED, str(error))
            return None
        finally:
            self._tell()  # what was noted before anything was raised
        return due

    def _handle_some(self, count: int) -> Due | None:
        if self._compiled is not None:
            return self._handle_compiled(count, self._compiled)
        if self._state.events >= self._max_events:
            self._end_without_event(self._state.queue.pop())
            return None
        due = self._handle(count)
        self._end_if_unroutable()
        return due

    def _tell(self) -> None:
        """Tell batch observers what has happened."""
        if self._state.log is not None:
            self._state.log.tell()

    def _handle(self, count: int) -> Due | None:
        state, setup, queue = self._state, self.setup, self._state.queue
        stop_at = min(state.events + count, self._max_events)
        soon, later, is_time = queue.soon, queue.later, queue.is_time
        noted = self._noted
        due: Due | None = None
        while state.events < stop_at and not state.unroutable:
            if soon and not (later and later[0] < soon[0]):  # as in queue.pop(), without the call
                due = heappop(soon)
            elif later:
                due = heappop(later)
                if due[1] == TRANSFER_COMPLETE and not is_time(due):
                    continue
            else:
                self._end_with_nothing_left()
                return None
            at_us, kind, _, number = due
            if at_us != state.now_us:
                if not state.now_us < at_us <= self._last_us:
                    self._end_without_event(due)
                    return None
                state.now_us = at_us
            state.events += 1
            if noted is not None:
                noted.append(due)
            HANDLERS[kind](number, state, setup)
        return due

    def _handle_compiled(self, count: int, run: "CompiledRun") -> Due | None:
        self._is_behind = True
        goes_on = run.advance(count)
        self._end_if_unroutable()
        if not goes_on:
            self._end_without_event(run.due)
            return None
        return run.due

    def give_up(self, detail: str) -> None:
        """End the run with status ``limit_reached`` for a reason of the caller's.

        Raises:
            ValueError: It has ended already.
        """
        if self.outcome is not None:
            raise ValueError("this run has ended")
        if self._compiled is not None:
            self._compiled.catch_up()
        self._end(RunStatus.LIMIT_REACHED, detail)

    def _end_without_event(self, due: Due | None) -> None:
        state, limits = self._state, self.setup.limits
        if due is None:
            self._end_with_nothing_left()
        elif due[0] < state.now_us:
            raise EngineError(f"time went back from {state.now_us} to {due[0]} us")
        elif state.events >= self._max_events:
            self._end(RunStatus.LIMIT_REACHED, f"the limit of {limits.max_events} events")
        elif limits.max_time_us is None or limits.max_time_us > HORIZON_us:
            self._end(RunStatus.FAILED, _endless_detail(due, self.setup))
        else:
            limit_s = s_from_us(limits.max_time_us)
            self._end(RunStatus.LIMIT_REACHED, f"the limit of {limit_s} simulated seconds")

    def _end_with_nothing_left(self) -> None:
        if self._state.unfinished_tasks == 0:
            self._end(RunStatus.COMPLETED, "")
            return
        state = self.state
        if state.flows:
            self._end(RunStatus.BLOCKED_WIRELESS, _blocked_detail(state, self.setup))
        else:
            raise EngineError(
                f"nothing is left to happen, yet {state.unfinished_tasks} tasks have not ended"
            )

    def _end_if_unroutable(self) -> None:
        if self._state.unroutable:
            self._end(RunStatus.UNROUTABLE, _unroutable_detail(self._state, self.setup))

    def _end(self, status: RunStatus, detail: str) -> None:
        self._tell()
        state = self._state
        makespan_us = state.last_task_end_us if status is RunStatus.COMPLETED else None
        self.outcome = Outcome(status, state.now_us, makespan_us, state.events, detail)
        for watcher in state.watchers:
            watcher.run_ended(self.outcome)


def _blocked_detail(state: State, setup: Setup) -> str:
    """Return which transfers wait at zero rate, and on which link."""
    lines = []
    for transfer in state.transfers.values():
        if not transfer.is_under_way:
            continue
        dag = setup.injections[transfer.entry.dag].dag
        source, target = (
            state.tasks[n].entry.task.id for n in (transfer.entry.source, transfer.entry.target)
        )
        link = setup.network.links[transfer.bottleneck].id
        left = f"{transfer.remaining_MB:.6g} MB left"
        lines.append(f"{dag.id}: {source} -> {target} ({left}, stalled on link {link})")
    return _listed("transfers stopped by interference", lines)


def _endless_detail(due: Due, setup: Setup) -> str:
    """Return what would happen after the end of time, and why."""
    kind, number = EventKind(due[1]), due[3]
    if kind is EventKind.DAG_INJECT:
        what = f"DAG {setup.injections[number].dag.id}, whose time is too late"
    elif kind in (EventKind.TRANSFER_START, EventKind.TRANSFER_COMPLETE):
        entry = setup.dependencies[number]
        ends = f"{setup.tasks[entry.source].task.id} -> {setup.tasks[entry.target].task.id}"
        dag = setup.injections[entry.dag].dag.id
        what = f"transfer {dag}: {ends}, whose size over rate or latency is too large"
    else:
        task = setup.tasks[number]
        dag = setup.injections[task.dag].dag.id
        what = f"task {dag}: {task.task.id}, whose cost over capacity is too large"
    return f"the next event lies beyond {s_from_us(HORIZON_us):.0f} s, where runs end: {what}"


def _unroutable_detail(state: State, setup: Setup) -> str:
    text = _listed("dependencies without a usable route", state.unroutable)
    network = setup.network
    dead = [
        link.id
        for link, bandwidth_MBps in zip(network.links, network.bandwidth_MBps, strict=True)
        if bandwidth_MBps == 0
    ]
    if not dead:
        return text
    return f"{text}. Links without bandwidth: {some_of(dead, MAX_LINKS_IN_DETAIL)}"


def _listed(what: str, lines: list[str]) -> str:
    more = len(lines) - MAX_LINES_IN_DETAIL
    shown = "; ".join(lines[:MAX_LINES_IN_DETAIL])
    return f"{len(lines)} {what}: {shown}" + (f"; and {more} more" if more > 0 else "")
