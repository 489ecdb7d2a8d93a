"""One run: take the next event, handle it, until nothing is left or a reason to stop appears."""

from collections.abc import Iterable
from typing import assert_never

from ncsim_core.engine.events import (
    DagInject,
    Event,
    TaskComplete,
    TaskReady,
    TaskStart,
    TransferComplete,
    TransferStart,
)
from ncsim_core.engine.observer import Observer
from ncsim_core.engine.outcome import Outcome, RunStatus
from ncsim_core.engine.setup import Limits, Reach, Setup
from ncsim_core.engine.state import State
from ncsim_core.engine.tasks import (
    complete_task,
    deliver_input,
    inject_dag,
    start_task,
    task_becomes_ready,
)
from ncsim_core.engine.transfers import complete_transfer, start_transfer
from ncsim_core.errors import EngineError, NcsimError
from ncsim_core.models import Models
from ncsim_core.network import Network
from ncsim_core.units import s_from_us

MAX_LINES_IN_DETAIL = 20


class Simulation:
    """A run that can be stepped, watched and asked.

    Args:
        network: Nodes and links, rates decided.
        models: The six components.
        limits: When to give up.
        observers: Who watches, from the first event on.
        reach: How far a refresh looks; ``Reach.GLOBAL`` is the slow oracle of the tests.

    Raises:
        PluginError: The DAG source's injections are out of order or ambiguous.
    """

    def __init__(
        self,
        network: Network,
        models: Models,
        limits: Limits | None = None,
        observers: Iterable[Observer] = (),
        *,
        reach: Reach = Reach.LOCAL,
    ) -> None:
        self.setup = Setup.of(network, models, limits or Limits(), reach)
        self.state = State.of(self.setup)
        self.outcome: Outcome | None = None
        for number, injection in enumerate(self.setup.injections):
            self.state.queue.push(injection.at_us, DagInject.priority, DagInject(number))
        for observer in observers:
            self.observe(observer)

    def observe(self, observer: Observer) -> None:
        """Let somebody watch the rest of the run.

        Raises:
            ValueError: The first event has been handled already.
        """
        state = self.state
        if state.events or self.outcome is not None:
            raise ValueError("observers must be added before the first event is handled")
        state.observers += (observer,)
        if observer.wants_rates:
            state.rate_observers += (observer,)
        observer.run_started(self.setup)

    def run(self) -> Outcome:
        """Step until the run ends, and return how it did."""
        while self.outcome is None:
            self.step()
        return self.outcome

    def step(self) -> Event | None:
        """Handle the next event and return it; ``None`` once the run has ended.

        What goes wrong in a component ends the run with status ``failed``.

        Raises:
            EngineError: The engine broke one of its own invariants.
        """
        if self.outcome is not None:
            return None
        try:
            event = self._next_event()
            if event is not None:
                self._handle(event)
        except EngineError:
            raise
        except NcsimError as error:
            self._end(RunStatus.FAILED, str(error))
            return None
        if self.state.unroutable:
            self._end(RunStatus.UNROUTABLE, _unroutable_detail(self.state))
        return event

    def _next_event(self) -> Event | None:
        """Move to the next event, or end the run if there is none that may happen."""
        state, limits = self.state, self.setup.limits
        if limits.max_events is not None and state.events >= limits.max_events and state.queue:
            self._end(RunStatus.LIMIT_REACHED, f"the limit of {limits.max_events} events")
            return None
        due = state.queue.peek()
        if due is None:
            self._end_with_nothing_left()
            return None
        if limits.max_time_us is not None and due.at_us > limits.max_time_us:
            limit_s = s_from_us(limits.max_time_us)
            self._end(RunStatus.LIMIT_REACHED, f"the limit of {limit_s} simulated seconds")
            return None
        state.queue.pop()
        if due.at_us < state.now_us:
            raise EngineError(f"time went back from {state.now_us} to {due.at_us} us")
        state.now_us = due.at_us
        state.events += 1
        return due.event

    def _handle(self, event: Event) -> None:
        state, setup = self.state, self.setup
        match event:
            case DagInject(dag):
                inject_dag(dag, state, setup)
            case TaskComplete(task):
                complete_task(task, state, setup)
            case TransferComplete(transfer):
                complete_transfer(transfer, state, setup)
                deliver_input(state.tasks[transfer.entry.target], state)
            case TaskReady(task):
                task_becomes_ready(task, state, setup)
            case TaskStart(task):
                start_task(task, state, setup)
            case TransferStart(transfer):
                start_transfer(transfer, state, setup)
            case _:
                assert_never(event)

    def _end_with_nothing_left(self) -> None:
        state = self.state
        if state.unfinished_tasks == 0:
            self._end(RunStatus.COMPLETED, "")
        elif state.flows:
            self._end(RunStatus.BLOCKED_WIRELESS, _blocked_detail(state, self.setup))
        else:
            raise EngineError(
                f"nothing is left to happen, yet {state.unfinished_tasks} tasks have not ended"
            )

    def _end(self, status: RunStatus, detail: str) -> None:
        state = self.state
        makespan_us = state.last_task_end_us if status is RunStatus.COMPLETED else None
        self.outcome = Outcome(status, state.now_us, makespan_us, state.events, detail)
        for observer in state.observers:
            observer.run_ended(self.outcome)


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


def _unroutable_detail(state: State) -> str:
    return _listed("dependencies without a usable route", state.unroutable)


def _listed(what: str, lines: list[str]) -> str:
    more = len(lines) - MAX_LINES_IN_DETAIL
    shown = "; ".join(lines[:MAX_LINES_IN_DETAIL])
    return f"{len(lines)} {what}: {shown}" + (f"; and {more} more" if more > 0 else "")
