"""What is fixed in a run: the network, who decides, and what is asked, all numbered.

Tasks and dependencies of all DAGs are numbered through, in order of injection and then of
the file, so that the engine works on lists.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property, partial
from itertools import repeat
from typing import NamedTuple

from ncsim_core.contracts.routing_model import RouteTable
from ncsim_core.engine.boundary import checked_injections
from ncsim_core.models import Models
from ncsim_core.network import Network
from ncsim_core.units import Instant
from ncsim_core.workflow import DAG, Injection, Task


class TaskEntry(NamedTuple):
    """A task of the run.

    Args:
        number: Its number in the run.
        dag: Number of its injection.
        task: The task itself.
        outgoing: Numbers of the dependencies it feeds, in file order.
        incoming_count: How many dependencies it waits for.
    """

    number: int
    dag: int
    task: Task
    outgoing: tuple[int, ...]
    incoming_count: int


class DependencyEntry(NamedTuple):
    """A dependency of the run.

    Args:
        number: Its number in the run, also that of its transfer.
        dag: Number of its injection.
        source: Number of the producing task.
        target: Number of the waiting task.
        size_MB: Payload.
        rank: Place among all dependencies of the run in the text order of (DAG, producing
            task, waiting task); breaks ties between transfers that end together.
    """

    number: int
    dag: int
    source: int
    target: int
    size_MB: float
    rank: int


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
        dags = [injection.dag for injection in injections]
        first_task = _running_totals([len(dag.tasks) for dag in dags])
        first_dependency = _running_totals([len(dag.dependencies) for dag in dags])
        ranks = _ranks(dags)
        tasks: list[TaskEntry] = []
        dependencies: list[DependencyEntry] = []
        for number, dag in enumerate(dags):
            entries = _dependency_entries(
                number, dag, first_task[number], first_dependency[number], ranks
            )
            dependencies += entries
            tasks += _task_entries(number, dag, first_task[number], entries)
        label = str(models.identity("routing_model"))
        routes = models.routes or RouteTable(models.routing, network, label)
        return cls(
            network,
            models,
            injections,
            tuple(tasks),
            tuple(dependencies),
            first_task,
            first_dependency,
            routes,
            limits,
            reach,
        )


def _running_totals(counts: Sequence[int]) -> tuple[int, ...]:
    totals, total = [], 0
    for count in counts:
        totals.append(total)
        total += count
    return tuple(totals)


def _ranks(dags: Sequence[DAG]) -> list[int]:
    """Return the rank of each dependency of the run, by its number."""
    keys: list[tuple[str, str, str]] = [
        (dag.id, dependency.source, dependency.target)
        for dag in dags
        for dependency in dag.dependencies
    ]
    ranks = [0] * len(keys)
    for rank, number in enumerate(sorted(range(len(keys)), key=keys.__getitem__)):
        ranks[number] = rank
    return ranks


def _dependency_entries(
    dag_number: int, dag: DAG, first_task: int, first_dependency: int, ranks: Sequence[int]
) -> list[DependencyEntry]:
    index, dependencies = dag.task_index, dag.dependencies
    numbers = range(first_dependency, first_dependency + len(dependencies))
    fields = zip(
        numbers,
        repeat(dag_number),
        [first_task + index[each.source] for each in dependencies],
        [first_task + index[each.target] for each in dependencies],
        [each.data_size_MB for each in dependencies],
        [ranks[number] for number in numbers],
    )
    return list(map(partial(tuple.__new__, DependencyEntry), fields))


def _task_entries(
    dag_number: int, dag: DAG, first_task: int, dependencies: Sequence[DependencyEntry]
) -> list[TaskEntry]:
    outgoing: list[list[int]] = [[] for _ in dag.tasks]
    incoming_count = [0] * len(dag.tasks)
    for dependency in dependencies:
        outgoing[dependency.source - first_task].append(dependency.number)
        incoming_count[dependency.target - first_task] += 1
    numbers = range(first_task, first_task + len(dag.tasks))
    fields = zip(numbers, repeat(dag_number), dag.tasks, map(tuple, outgoing), incoming_count)
    return list(map(partial(tuple.__new__, TaskEntry), fields))
