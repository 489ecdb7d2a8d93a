"""What can be watched while a run goes on.

Tasks and dependencies are told apart by their number in the run (``Setup.tasks`` and
``Setup.dependencies``), nodes and links by their index in the network. A transfer has the
number of its dependency.
"""

from collections.abc import Sequence
from functools import partial
from typing import Final, Literal, NamedTuple, TypeAlias

from ncsim_core.contracts.interference_model import Competition
from ncsim_core.engine.outcome import Outcome
from ncsim_core.engine.setup import Setup
from ncsim_core.network import LinkIndex, NodeIndex
from ncsim_core.units import Instant


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


RateColumns: TypeAlias = tuple[
    Sequence[int], Sequence[float], Sequence[LinkIndex], Sequence[int], Sequence[Competition]
]
"""Several rate changes as columns of equal length, one for each field of ``RateChange``."""

rate_cause_of: Final = partial(tuple.__new__, RateCause)
_rate_change_of: Final = partial(tuple.__new__, RateChange)
"""Make a ``RateCause`` or ``RateChange`` of a tuple, in a third of the time of naming fields."""


class Observer:
    """Base of everything that watches a run; override what you want to see.

    The engine calls these in the order in which things happen and never looks at what
    they do. An observer must not change what it is shown.
    """

    wants_rates = True
    """Whether ``rates_assigned`` is called; without it runs are a little faster."""

    may_lag = False
    """Whether calls may come some thousand events late, in the same order; for those who look at
    nothing but what they are told. Compiled runs are only for such observers."""

    def run_started(self, setup: Setup) -> None:
        """Called once, before the first event."""

    def dag_injected(self, at_us: Instant, dag: int, nodes: Sequence[NodeIndex]) -> None:
        """A DAG has entered; ``nodes`` has the node of each of its tasks, in file order."""

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

    def rate_columns_assigned(self, at_us: Instant, cause: RateCause, columns: RateColumns) -> None:
        """The same in columns, which is how the engine tells it.

        Override this instead of ``rates_assigned`` to save making an object of every change.
        """
        self.rates_assigned(at_us, cause, [*map(_rate_change_of, zip(*columns, strict=True))])

    def transfer_ended(self, at_us: Instant, transfer: int) -> None:
        """The last byte has been served."""

    def run_ended(self, outcome: Outcome) -> None:
        """Called once, after the last event."""
