"""Who decides: the six components of a run, built and named."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from typing_extensions import override

from ncsim_core.contracts.dag_source import DAGSource
from ncsim_core.contracts.interference_model import InterferenceModel
from ncsim_core.contracts.link_model import LinkModel
from ncsim_core.contracts.queue_model import QueueModel
from ncsim_core.contracts.routing_model import RouteTable, RoutingModel
from ncsim_core.contracts.scheduler import Scheduler


@dataclass(frozen=True)
class ComponentIdentity:
    """Which component answers for a kind, for traces and for blame.

    Args:
        kind: One of the six kinds, such as ``scheduler``.
        name: Name it was asked for by, such as ``heft``.
        distribution: Package that provides it.
        version: Version of that package.
        factory: Import string of what built it.
        options: Resolved options, defaults included.
    """

    kind: str
    name: str
    distribution: str = "unknown"
    version: str = "0"
    factory: str = ""
    options: Mapping[str, object] = field(default_factory=dict)

    @override
    def __str__(self) -> str:
        return f"{self.kind} {self.name!r} ({self.distribution} {self.version})"


@dataclass(frozen=True)
class Models:
    """The six components of one run.

    Args:
        scheduler: Places tasks.
        routing: Chooses routes.
        link_model: Decided the clean rates.
        interference: Slows links down.
        new_queue: Builds the waiting line of one node.
        dag_source: Says which DAGs arrive.
        identities: By kind, who these are.
        routes: Routes of the run's network that earlier runs have worked out, if they are shared.
    """

    scheduler: Scheduler
    routing: RoutingModel
    link_model: LinkModel
    interference: InterferenceModel
    new_queue: Callable[[], QueueModel]
    dag_source: DAGSource
    identities: Mapping[str, ComponentIdentity] = field(default_factory=dict)
    routes: RouteTable | None = None

    def identity(self, kind: str) -> ComponentIdentity:
        """Return who answers for a kind."""
        return self.identities.get(kind, ComponentIdentity(kind, "unnamed"))
