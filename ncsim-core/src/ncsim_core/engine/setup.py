"""What is fixed in a run: the network, who decides, and what is asked, all numbered."""

from dataclasses import dataclass
from enum import Enum
from functools import cached_property

from ncsim_core.contracts.routing_model import RouteTable
from ncsim_core.engine.boundary import checked_injections
from ncsim_core.engine.numbering import DependencyEntry, TaskEntry, numbering_of
from ncsim_core.models import Models
from ncsim_core.network import Network
from ncsim_core.units import Instant
from ncsim_core.workflow import Injection


@dataclass(frozen=True)
class Limits:
    """When to give up on a run.

    Args:
        max_events: Events to handle at most.
        max_time_us: Simulated time that no event may pass.
    """

    max_events: int | None = None
    max_time_us: Instant | None = None


class Reach(Enum):
    """How far a refresh looks."""

    LOCAL = "local"
    """Only what the interference model names can move: what runs use."""
    GLOBAL = "global"
    """Every active link and transfer, always: the slow oracle that tests compare with."""


@dataclass(frozen=True)
class Setup:
    """What is fixed in a run.

    Args:
        network: Nodes and links, rates decided.
        models: The six components.
        injections: Which DAGs enter, in order of time.
        tasks: All tasks by number.
        dependencies: All dependencies by number.
        first_task: By injection, the number of its first task.
        first_dependency: By injection, the number of its first dependency.
        routes: The route between any two nodes.
        limits: When to give up.
        reach: How far a refresh looks.
    """

    network: Network
    models: Models
    injections: tuple[Injection, ...]
    tasks: tuple[TaskEntry, ...]
    dependencies: tuple[DependencyEntry, ...]
    first_task: tuple[int, ...]
    first_dependency: tuple[int, ...]
    routes: RouteTable
    limits: Limits
    reach: Reach = Reach.LOCAL

    @cached_property
    def bandwidth_MBps(self) -> tuple[float, ...]:
        """Return the clean bandwidth of each link."""
        return self.network.bandwidth_MBps

    @cached_property
    def is_global(self) -> bool:
        """Return whether every refresh looks at everything."""
        return self.reach is Reach.GLOBAL

    @cached_property
    def is_without_latency(self) -> bool:
        """Return whether no link has any latency."""
        return not any(self.network.latency_s)

    @cached_property
    def decides_routes(self) -> bool:
        """Return whether the interference model gives whole routes their rates."""
        return self.models.interference.decides_routes

    @classmethod
    def of(
        cls, network: Network, models: Models, limits: Limits, reach: Reach = Reach.LOCAL
    ) -> "Setup":
        """Return the setup of a run on a network whose rates are decided.

        Raises:
            PluginError: The DAG source's injections are out of order or ambiguous.
        """
        injections = checked_injections(models)
        numbering = numbering_of([injection.dag for injection in injections])
        label = str(models.identity("routing_model"))
        routes = models.routes or RouteTable(models.routing, network, label)
        return cls(
            network,
            models,
            injections,
            numbering.tasks,
            numbering.dependencies,
            numbering.first_task,
            numbering.first_dependency,
            routes,
            limits,
            reach,
        )
