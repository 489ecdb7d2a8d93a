"""Keeps a run in memory as the tables that its trace would give, without a file."""

from collections.abc import Sequence

from typing_extensions import override

from ncsim_core.engine.events import (
    TASK_COMPLETE,
    TASK_READY,
    TASK_START,
    TRANSFER_COMPLETE,
    TRANSFER_START,
)
from ncsim_core.engine.observer import Batch, BatchObserver, RateColumns, changes_of
from ncsim_core.engine.outcome import Outcome
from ncsim_core.engine.setup import Setup
from ncsim_core.network import NodeIndex, Route
from ncsim_core.trace.building import RunBuilder
from ncsim_core.trace.records import (
    VERSION,
    TraceHeader,
    TraceLevel,
    TracePreamble,
)
from ncsim_core.trace.run_trace import RateStep, RunEnd, RunTrace
from ncsim_core.trace.tables import injected_record, link_rows, node_rows
from ncsim_core.units import Instant


class RunRecorder(BatchObserver):
    """Observer that makes a ``RunTrace`` of a run.

    Args:
        header: What the tables say about the scenario.
        level: ``coarse`` looks at no rates; all metrics of completed runs do without.
        keeps_steps: Whether every rate is kept, as explanations need it. Without, metrics are
            those of a full trace and memory does not grow with the number of rates.
    """

    def __init__(
        self,
        header: TraceHeader | None = None,
        level: TraceLevel = "full",
        *,
        keeps_steps: bool = True,
    ) -> None:
        self.wants_rates = level == "full"
        self._header = header or TraceHeader()
        self._level = level
        self._keeps_steps = keeps_steps
        self._setup: Setup | None = None
        self._builder: RunBuilder | None = None

    def run_trace(self) -> RunTrace:
        """Return the run as far as it has come.

        Raises:
            ValueError: It has not begun.
        """
        return self._begun.build()

    @property
    def _begun(self) -> RunBuilder:
        if self._builder is None:
            raise ValueError("this recorder has not seen a run yet")
        return self._builder

    @override
    def run_started(self, setup: Setup) -> None:
        preamble = TracePreamble(
            header=self._header,
            version=VERSION,
            level=self._level,
            plugins=setup.models.identities,
            nodes=node_rows(setup.network),
            links=link_rows(setup.network),
        )
        self._setup, self._builder = setup, RunBuilder(preamble, keeps_steps=self._keeps_steps)

    @override
    def dag_injected(self, at_us: Instant, dag: int, nodes: Sequence[NodeIndex]) -> None:
        assert self._setup is not None  # the engine starts runs before it injects
        self._begun.inject(injected_record(self._setup, at_us, dag))
        self._begun.place(dag, nodes)

    @override
    def events_happened(self, batch: Batch) -> None:
        builder = self._begun
        times_us = {
            TASK_READY: builder.ready_us,
            TASK_START: builder.started_us,
            TASK_COMPLETE: builder.ended_us,
            TRANSFER_START: builder.transfer_started_us,
        }
        rates = batch.rates if self.wants_rates else {}
        for place, (at_us, kind, _, number) in enumerate(batch.events):
            if kind in times_us:
                times_us[kind][number] = at_us
            if kind == TRANSFER_START:
                builder.route[number] = self._route_of(number)
            elif kind == TRANSFER_COMPLETE:
                builder.end_transfer(number, at_us)
            if place in rates:
                self._assign(at_us, kind, number, rates[place])

    def _route_of(self, number: int) -> Route:
        assert self._setup is not None
        entry, nodes = self._setup.dependencies[number], self._begun.node_of_task
        source, target = nodes[entry.source], nodes[entry.target]
        assert source is not None  # what travels has been placed
        assert target is not None
        return self._setup.routes.route(source, target) or ()

    def _assign(self, at_us: Instant, kind: int, number: int, columns: RateColumns) -> None:
        builder = self._begun
        if not self._keeps_steps:
            for transfer, rate_MBps in zip(*columns[:2], strict=True):
                builder.set_rate(transfer, at_us, rate_MBps)
            return
        by = "s" if kind == TRANSFER_START else "e"
        for change in changes_of(columns):
            step = RateStep(
                at_us,
                change.rate_MBps,
                change.bottleneck,
                *change.competition,
                change.flows_on_link,
                by,
                number,
            )
            builder.add_step(change.transfer, step)

    @override
    def run_ended(self, outcome: Outcome) -> None:
        self._begun.end = RunEnd(
            str(outcome.status),
            outcome.ended_us,
            outcome.makespan_us,
            outcome.events,
            outcome.detail,
        )
