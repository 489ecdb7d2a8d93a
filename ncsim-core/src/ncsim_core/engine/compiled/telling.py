"""What the compiled loop noted, told to observers as the engine tells it."""

from collections.abc import Sequence
from operator import itemgetter
from typing import Final, TypeAlias

from ncsim_core.contracts.interference_model import NO_COMPETITION, competition_of
from ncsim_core.contracts.interference_tables import InterferenceTables
from ncsim_core.engine.compiled import layout
from ncsim_core.engine.compiled.arrays import Arrays, records
from ncsim_core.engine.events import (
    TASK_COMPLETE,
    TASK_READY,
    TASK_START,
    TRANSFER_COMPLETE,
    TRANSFER_START,
)
from ncsim_core.engine.observer import RateColumns, rate_cause_of
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import State
from ncsim_core.units import Instant

EVENTS_KEPT: Final = 4096
RATES_KEPT: Final = 16_384
"""How much is noted before observers are told; 1 MB."""

Assigned: TypeAlias = tuple[float, int, int, int, int, int, int]
"""A row of the array ``assigned``."""

TRANSFER_OF: Final = itemgetter(1)


class Teller:
    """Tells the observers of one run what the loop has noted.

    Args:
        arrays: Of the run; its log is put in.
        state: Whose observers are told.
        setup: Of the run.
        tables: What the interference model knows of competition, if it has any.
    """

    def __init__(
        self, arrays: Arrays, state: State, setup: Setup, tables: InterferenceTables | None
    ) -> None:
        self._arrays = arrays
        self._state = state
        self._setup = setup
        self._tables = tables
        self._of_task = {
            TASK_READY: [observer.task_ready for observer in state.observers],
            TASK_START: [observer.task_started for observer in state.observers],
            TASK_COMPLETE: [observer.task_ended for observer in state.observers],
        }
        record = arrays.state
        record.is_watched, record.shows_rates = bool(state.observers), bool(state.rate_observers)
        record.happened_most = EVENTS_KEPT
        arrays.put(
            "happened", records(EVENTS_KEPT if state.observers else 0, layout.ARRAYS["happened"])
        )
        self._keep_rates(RATES_KEPT if state.rate_observers else 0)

    def _keep_rates(self, count: int) -> None:
        self._arrays.state.assigned_most = count
        self._arrays.put("assigned", records(count, layout.ARRAYS["assigned"]))

    def tell(self) -> None:
        """Tell all that has been noted; make room for one event at least.

        While it is told, the state's clock and count of events are those of what is told.
        """
        record, state = self._arrays.state, self._state
        happened = self._arrays["happened"][: int(record.happened_count)].tolist()
        assigned = iter(self._arrays["assigned"][: int(record.assigned_count)].tolist())
        record.happened_count = record.assigned_count = 0
        if record.shows_rates and record.flows >= record.assigned_most:
            self._keep_rates(2 * int(record.flows) + 2)
        events = int(record.events) - len(happened)
        for number, (at_us, kind, what, moves) in enumerate(happened, events + 1):
            state.now_us, state.events = at_us, number
            self._tell_event(at_us, kind, what)
            if moves:
                self._tell_rates(at_us, kind, what, [next(assigned) for _ in range(moves)])

    def _tell_event(self, at_us: Instant, kind: int, number: int) -> None:
        if kind in self._of_task:
            node = self._state.tasks[number].node
            for tell in self._of_task[kind]:
                tell(at_us, number, node)
        elif kind == TRANSFER_START:
            self._tell_transfer(at_us, number)
        elif kind == TRANSFER_COMPLETE:
            for observer in self._state.observers:
                observer.transfer_ended(at_us, number)

    def _tell_transfer(self, at_us: Instant, number: int) -> None:
        entry, tasks = self._setup.dependencies[number], self._state.tasks
        source, target = tasks[entry.source].node, tasks[entry.target].node
        route = self._setup.routes.route(source, target) or ()
        for observer in self._state.observers:
            observer.transfer_started(at_us, number, route, entry.size_MB)

    def _tell_rates(
        self, at_us: Instant, kind: int, number: int, assigned: Sequence[Assigned]
    ) -> None:
        cause = rate_cause_of(("start" if kind == TRANSFER_START else "finish", number))
        columns = self._columns(sorted(assigned, key=TRANSFER_OF))
        for observer in self._state.rate_observers:
            observer.rate_columns_assigned(at_us, cause, columns)

    def _columns(self, assigned: Sequence[Assigned]) -> RateColumns:
        rates_MBps, transfers, links, flows, *against = zip(*assigned, strict=True)
        if self._tables is None:
            return transfers, rates_MBps, links, flows, [NO_COMPETITION] * len(links)
        hidden_factors = self._tables.hidden_factors
        competition = [
            competition_of((contenders, hidden, hidden_factors[link][level]))
            for link, contenders, hidden, level in zip(links, *against, strict=True)
        ]
        return transfers, rates_MBps, links, flows, competition
