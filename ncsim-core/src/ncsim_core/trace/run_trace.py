"""A whole run as frozen tables, numbered as in the trace: what metrics and exports work on.

``load_run`` makes one from a file, ``RunRecorder`` from a run that is going on, without a file;
both feed the same builder, so what is computed from either is equal.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

from ncsim_core.models import ComponentIdentity
from ncsim_core.trace.records import LinkRow, NodeRow, TraceHeader


class RunDag(NamedTuple):
    """A DAG of the run; its tasks and edges have consecutive numbers."""

    number: int
    id: str
    injected_us: int
    first_task: int
    task_count: int
    first_edge: int
    edge_count: int


class RunTask(NamedTuple):
    """What became of a task; ``None`` for what did not happen.

    Args:
        number: Its number in the run.
        dag: Number of its DAG.
        id: Name within the DAG.
        cost: Compute units.
        node: Where it was placed.
        ready_us: When its last input arrived.
        started_us: When it began to run.
        ended_us: When it ended.
    """

    number: int
    dag: int
    id: str
    cost: float
    node: int | None = None
    ready_us: int | None = None
    started_us: int | None = None
    ended_us: int | None = None


class RateStep(NamedTuple):
    """A transfer's rate from an instant on, and what explains it.

    Args:
        at_us: From when on.
        rate_MBps: The rate; 0 while it is paused.
        bottleneck: Link that decides.
        contenders: Active links that the bottleneck shares the channel with.
        hidden_interferers: Active links that disturb its receiver unheard.
        hidden_factor: What hidden interferers alone leave of its rate.
        flows: Transfers that share the bottleneck, this one included.
        change: ``s`` if a transfer's start moved the rate, ``e`` if an end did.
        cause: That transfer.
    """

    at_us: int
    rate_MBps: float
    bottleneck: int
    contenders: int
    hidden_interferers: int
    hidden_factor: float
    flows: int
    change: str
    cause: int


class RunTransfer(NamedTuple):
    """What became of a dependency; ``None`` for what did not happen.

    Args:
        number: Its number in the run.
        dag: Number of its DAG.
        source: Producing task.
        target: Waiting task.
        size_MB: Payload.
        is_local: Whether both tasks are on one node, so that nothing travels.
        created_us: When the producing task ended.
        route: Links it occupies.
        started_us: When latency was paid and byte service began.
        ended_us: When its last byte was served.
        served_MB: Its size once it has ended; before, what its rates amount to (0 in a coarse
            trace).
        steps: Its rates in order of time; none in a coarse trace.
    """

    number: int
    dag: int
    source: int
    target: int
    size_MB: float
    is_local: bool = False
    created_us: int | None = None
    route: tuple[int, ...] = ()
    started_us: int | None = None
    ended_us: int | None = None
    served_MB: float = 0.0
    steps: tuple[RateStep, ...] = ()


@dataclass(frozen=True)
class RunEnd:
    """How a run ended; ``status`` is ``truncated`` if its trace does not say."""

    status: str
    ended_us: int
    makespan_us: int | None
    events: int
    detail: str = ""


TRUNCATED = "truncated"


@dataclass(frozen=True)
class RunTrace:
    """A run, whole.

    Args:
        header: What the trace says about its scenario.
        level: ``full``, or ``coarse`` when rates were not recorded.
        plugins: By kind, who decided.
        nodes: Nodes by number.
        links: Links by number.
        dags: DAGs in order of injection.
        tasks: Tasks by number.
        transfers: Dependencies by number, those within a node included.
        end: How it ended.
    """

    header: TraceHeader
    level: str
    plugins: Mapping[str, ComponentIdentity]
    nodes: tuple[NodeRow, ...]
    links: tuple[LinkRow, ...]
    dags: tuple[RunDag, ...]
    tasks: tuple[RunTask, ...]
    transfers: tuple[RunTransfer, ...]
    end: RunEnd

    @property
    def has_rates(self) -> bool:
        """Return whether rates were recorded."""
        return self.level == "full"

    @cached_property
    def incoming(self) -> tuple[tuple[int, ...], ...]:
        """Return for each task the numbers of the dependencies it waits for."""
        groups: list[list[int]] = [[] for _ in self.tasks]
        for transfer in self.transfers:
            groups[transfer.target].append(transfer.number)
        return tuple(map(tuple, groups))

    @property
    def remote_transfers(self) -> tuple[RunTransfer, ...]:
        """Return the dependencies that cross nodes, begun or not."""
        return tuple(transfer for transfer in self.transfers if not transfer.is_local)

    def task_label(self, number: int) -> str:
        """Return a task's name, with its DAG's if there are several."""
        task = self.tasks[number]
        return f"{self.dags[task.dag].id}/{task.id}" if len(self.dags) > 1 else task.id

    def transfer_label(self, number: int) -> str:
        """Return the names of a dependency's ends."""
        transfer = self.transfers[number]
        return f"{self.task_label(transfer.source)} -> {self.tasks[transfer.target].id}"

    def rate_spans(self, transfer: RunTransfer) -> Iterator[tuple[RateStep, int]]:
        """Yield each rate of a transfer with the instant until which it held."""
        last_us = self.end.ended_us if transfer.ended_us is None else transfer.ended_us
        for step, following in pairwise(transfer.steps):
            yield step, following.at_us
        if transfer.steps:
            yield transfer.steps[-1], last_us

    def solo_MBps(self, transfer: RunTransfer) -> float:
        """Return the rate of a transfer that has its route to itself: the least clean bandwidth."""
        return min(self.links[link].bandwidth_MBps for link in transfer.route)
