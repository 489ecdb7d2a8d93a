"""Keeps a run in memory as the tables that its trace would give, without a file."""

from collections.abc import Sequence

from typing_extensions import override

from ncsim_core.engine.observer import Observer, RateCause, RateChange
from ncsim_core.engine.outcome import Outcome
from ncsim_core.engine.setup import Setup
from ncsim_core.network import LinkIndex, NodeIndex
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


class RunRecorder(Observer):
    """Observer that makes a ``RunTrace`` of a run.

    Args:
        header: What the tables say about the scenario.
        level: ``coarse`` looks at no rates; all metrics of completed runs do without.
        keeps_steps: Whether every rate is kept, as explanations need it. Without, metrics are
            those of a full trace and memory does not grow with the number of rates.
    """

    may_lag = True

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
    def task_ready(self, at_us: Instant, task: int, node: NodeIndex) -> None:
        self._begun.ready_us[task] = at_us

    @override
    def task_started(self, at_us: Instant, task: int, node: NodeIndex) -> None:
        self._begun.started_us[task] = at_us

    @override
    def task_ended(self, at_us: Instant, task: int, node: NodeIndex) -> None:
        self._begun.ended_us[task] = at_us

    @override
    def transfer_started(
        self, at_us: Instant, transfer: int, route: Sequence[LinkIndex], size_MB: float
    ) -> None:
        self._begun.route[transfer] = tuple(route)
        self._begun.transfer_started_us[transfer] = at_us

    @override
    def transfer_ended(self, at_us: Instant, transfer: int) -> None:
        self._begun.end_transfer(transfer, at_us)

    @override
    def rates_assigned(
        self, at_us: Instant, cause: RateCause, changes: Sequence[RateChange]
    ) -> None:
        builder = self._begun
        if not self._keeps_steps:
            for change in changes:
                builder.set_rate(change.transfer, at_us, change.rate_MBps)
            return
        by = "s" if cause.change == "start" else "e"
        for change in changes:
            step = RateStep(
                at_us,
                change.rate_MBps,
                change.bottleneck,
                *change.competition,
                change.flows_on_link,
                by,
                cause.transfer,
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
