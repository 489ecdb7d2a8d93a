"""What stands in a trace, as types: the header and the ten kinds of record.

How they look in a file is in ``fields``.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, Self, TypeAlias

from ncsim_core.errors import ScenarioError
from ncsim_core.models import ComponentIdentity

if TYPE_CHECKING:
    from ncsim_core.scenario.model import Scenario

FORMAT: Final = "ncsim-trace"
VERSION: Final = "1.0"
"""Major and minor. A minor only adds kinds and fields; readers ignore what they do not know."""

TIME_UNIT: Final = "us"

TraceLevel: TypeAlias = Literal["full", "coarse"]
"""``coarse`` leaves ``recalc`` records out."""


class TraceError(ScenarioError):
    """A trace is not what it should be; a trace is input like a scenario."""


@dataclass(frozen=True)
class TraceHeader:
    """What a trace says about its scenario.

    Args:
        scenario: Name of the scenario.
        scenario_sha256: Hash of the resolved scenario.
        seed: Seed of the run.
        sections: Resolved config sections that viewers need, such as ``rf``.
        software: Name and version of what ran it; empty means this ncsim-core.
    """

    scenario: str = ""
    scenario_sha256: str = ""
    seed: int = 42
    sections: Mapping[str, object] = field(default_factory=dict)
    software: str = ""

    @classmethod
    def of(cls, scenario: "Scenario") -> Self:
        """Return the header of the trace of a scenario's run."""
        config = scenario.config
        return cls(scenario.name, scenario.sha256, config.seed, config.sections)


class NodeRow(NamedTuple):
    """A node as the header lists it; capacity in compute units per second."""

    id: str
    capacity: float
    x_m: float | None = None
    y_m: float | None = None


class LinkRow(NamedTuple):
    """A link as the header lists it; ``source`` and ``target`` are node indices."""

    id: str
    source: int
    target: int
    bandwidth_MBps: float
    latency_s: float = 0.0
    medium: str = "wireless"


@dataclass(frozen=True)
class TracePreamble:
    """The first line of a trace, read.

    Args:
        header: What it says about the scenario.
        version: Version of the format.
        level: ``full`` or ``coarse``.
        plugins: By kind, who decided.
        nodes: Table that node numbers point into.
        links: Table that link numbers point into.
    """

    header: TraceHeader
    version: str
    level: str
    plugins: Mapping[str, ComponentIdentity]
    nodes: tuple[NodeRow, ...]
    links: tuple[LinkRow, ...]


class Injected(NamedTuple):
    """A DAG has entered; the only place with the names of its tasks."""

    line: int
    at_us: int
    dag: int
    dag_id: str
    first_task: int
    first_edge: int
    tasks: list[tuple[str, float]]
    edges: list[tuple[int, int, float]]


class Placed(NamedTuple):
    """The node of each task of a DAG, in file order."""

    line: int
    at_us: int
    dag: int
    nodes: list[int]


class Ready(NamedTuple):
    """All inputs of a task have arrived."""

    line: int
    at_us: int
    task: int
    node: int


class Started(NamedTuple):
    """A task has begun to run."""

    line: int
    at_us: int
    task: int
    node: int


class Ended(NamedTuple):
    """A task has ended."""

    line: int
    at_us: int
    task: int
    node: int


class TransferStarted(NamedTuple):
    """A transfer's latency is paid and byte service begins."""

    line: int
    at_us: int
    transfer: int
    route: list[int]
    size_MB: float


class RatesAssigned(NamedTuple):
    """A start or end of a transfer has moved rates; the lists run in parallel."""

    line: int
    at_us: int
    cause: tuple[Literal["s", "e"], int]
    transfers: list[int]
    rates_MBps: list[float]
    bottlenecks: list[int]
    contenders: list[int]
    hidden_interferers: list[int]
    hidden_factors: list[float]
    flows: list[int]


class TransferEnded(NamedTuple):
    """The last byte of a transfer has been served."""

    line: int
    at_us: int
    transfer: int


class Note(NamedTuple):
    """Something a plug-in wanted on record."""

    line: int
    at_us: int
    namespace: str
    data: object


class Done(NamedTuple):
    """How the run ended; always the last record."""

    line: int
    at_us: int
    status: str
    makespan_us: int | None
    events: int
    detail: str
    counts: dict[str, int]


TraceRecord: TypeAlias = (
    Injected
    | Placed
    | Ready
    | Started
    | Ended
    | TransferStarted
    | RatesAssigned
    | TransferEnded
    | Note
    | Done
)
