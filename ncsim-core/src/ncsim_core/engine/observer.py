"""What can be watched while a run goes on: at once, event by event, or in batches.

Tasks and dependencies are told apart by their number in the run (``Setup.tasks`` and
``Setup.dependencies``), nodes and links by their index in the network. A transfer has the
number of its dependency.
"""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple, TypeAlias

from ncsim_core.contracts.interference_model import NO_COMPETITION, Against, Competition
from ncsim_core.engine.event_queue import Due
from ncsim_core.engine.outcome import Outcome
from ncsim_core.engine.setup import Setup
from ncsim_core.network import LinkIndex, NodeIndex
from ncsim_core.units import Instant


class Watcher:
    """What all who watch a run are told; derive from ``Observer`` or ``BatchObserver``.

    The engine calls these in the order in which things happen and never looks at what
    they do. Nobody may change what is shown.
    """

    wants_rates = True
    """Whether rates are told; without them runs are a little faster."""

    def run_started(self, setup: Setup) -> None:
        """Called once, before the first event."""

    def dag_injected(self, at_us: Instant, dag: int, nodes: Sequence[NodeIndex]) -> None:
        """A DAG has entered; ``nodes`` has the node of each of its tasks, in file order."""

    def run_ended(self, outcome: Outcome) -> None:
        """Called once, after the last event."""


class RateCause(NamedTuple):
    """The transfer whose start or finish made rates move."""

    change: Literal["start", "finish"]
    transfer: int


class RateChange(NamedTuple):
    """A transfer's new rate.

    Args:
        transfer: Number of its dependency.
        rate_MBps: The new rate; 0 means that it is paused.
        bottleneck: The first link of its route with the least share.
        flows_on_link: Transfers that share the bottleneck, this one included.
        competition: What the bottleneck link is up against.
    """

    transfer: int
    rate_MBps: float
    bottleneck: LinkIndex
    flows_on_link: int
    competition: Competition


class Observer(Watcher):
    """Is told of every event when it happens, and may look at the state of the run then."""

    def task_ready(self, at_us: Instant, task: int, node: NodeIndex) -> None:
        """All inputs of a task have arrived."""

    def task_started(self, at_us: Instant, task: int, node: NodeIndex) -> None:
        """A task has begun to run."""

    def task_ended(self, at_us: Instant, task: int, node: NodeIndex) -> None:
        """A task has ended and its node is free."""

    def transfer_started(
        self, at_us: Instant, transfer: int, route: Sequence[LinkIndex], size_MB: float
    ) -> None:
        """Latency is paid and byte service begins."""

    def rates_assigned(
        self, at_us: Instant, cause: RateCause, changes: Sequence[RateChange]
    ) -> None:
        """Rates have moved; one call per start or finish that moved any."""

    def transfer_ended(self, at_us: Instant, transfer: int) -> None:
        """The last byte has been served."""


RateColumns: TypeAlias = tuple[
    Sequence[int], Sequence[float], Sequence[LinkIndex], Sequence[int], Against | None
]
"""Several rate changes in order of their transfers: the fields of ``RateChange`` as columns.

The last is ``None`` under a model by which no link affects another.
"""


def changes_of(columns: RateColumns) -> list[RateChange]:
    """Return rate changes as one object per transfer."""
    *plain, against = columns
    competition = (
        [NO_COMPETITION] * len(columns[0])
        if against is None
        else map(Competition._make, zip(*against, strict=True))
    )
    return list(map(RateChange, *plain, competition))


class Batch(NamedTuple):
    """What has happened since the last batch.

    Args:
        events: In order: time, kind (``engine/events.py``), a number of no meaning here, number of
            the DAG, task or transfer. Injections are among them, and told by ``dag_injected`` too.
        rates: What the start or finish of a transfer moved, by its place in ``events``.
    """

    events: Sequence[Due]
    rates: Mapping[int, RateColumns]


class BatchObserver(Watcher):
    """Is told later, of many events at once, for a fraction of the time; good for records.

    Nothing is held back for longer than some tenths of a second, nor when a DAG enters or the run
    ends. Only runs that nobody watches at once may go through the compiled loop.
    """

    @abstractmethod
    def events_happened(self, batch: Batch) -> None:
        """Take note of a batch, which is not kept: its lists are used again."""
