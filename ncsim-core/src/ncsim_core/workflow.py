"""What is asked of the network: tasks, dependencies, DAGs, and where a plan puts them.

All of it is frozen; progress lives in ``ncsim_core.engine.state``.
"""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import NewType

from ncsim_core.errors import ScenarioError
from ncsim_core.network import NodeId
from ncsim_core.units import MAX_QUANTITY, Instant, is_quantity

TaskId = NewType("TaskId", str)
DagId = NewType("DagId", str)


@dataclass(frozen=True, slots=True)
class Task:
    """A piece of work that occupies one node.

    Args:
        id: Unique within its DAG.
        compute_cost: Compute units, finite, 0 or more.
        pinned_to: Node that must run it; ``None`` leaves the choice to the scheduler.
    """

    id: TaskId
    compute_cost: float
    pinned_to: NodeId | None = None


@dataclass(frozen=True, slots=True)
class Dependency:
    """Data that one task hands to another before the other can begin.

    Args:
        source: Id of the producing task.
        target: Id of the consuming task.
        data_size_MB: Payload, finite, 0 or more.
    """

    source: TaskId
    target: TaskId
    data_size_MB: float


@dataclass(frozen=True)
class DAG:
    """Tasks and their dependencies, in file order.

    Raises:
        ScenarioError: An id or dependency is given twice, a dependency names an unknown
            task, the dependencies form a cycle, or a quantity is not from 0 to ``MAX_QUANTITY``.
    """

    id: DagId
    tasks: tuple[Task, ...]
    dependencies: tuple[Dependency, ...]

    def __post_init__(self) -> None:
        _check_tasks(self)
        _check_dependencies(self)
        ends = [(each.source, each.target) for each in self.dependencies]
        cycle = find_cycle((task.id for task in self.tasks), ends)
        if cycle:
            raise ScenarioError(f"DAG {self.id!r} has a cycle: {' -> '.join(cycle)}")

    @cached_property
    def task_index(self) -> Mapping[TaskId, int]:
        """Return the position of each task id in ``tasks``."""
        return {task.id: index for index, task in enumerate(self.tasks)}

    @cached_property
    def outgoing(self) -> Mapping[TaskId, tuple[Dependency, ...]]:
        """Return for each task the dependencies it feeds, in file order."""
        return self._grouped(by_source=True)

    @cached_property
    def incoming(self) -> Mapping[TaskId, tuple[Dependency, ...]]:
        """Return for each task the dependencies it waits for, in file order."""
        return self._grouped(by_source=False)

    def _grouped(self, *, by_source: bool) -> Mapping[TaskId, tuple[Dependency, ...]]:
        groups: dict[TaskId, list[Dependency]] = {task.id: [] for task in self.tasks}
        for dependency in self.dependencies:
            groups[dependency.source if by_source else dependency.target].append(dependency)
        return {task_id: tuple(group) for task_id, group in groups.items()}


@dataclass(frozen=True, slots=True)
class Injection:
    """A DAG entering the run at a time."""

    at_us: Instant
    dag: DAG


@dataclass(frozen=True)
class PlacementPlan:
    """The node of every task of one DAG; it never implies an order."""

    nodes: Mapping[TaskId, NodeId] = field(default_factory=dict)


def find_cycle(tasks: Iterable[str], edges: Collection[tuple[str, str]]) -> list[str]:
    """Return the tasks of one cycle, first repeated at the end, or an empty list.

    Iterative, so that a chain of any length is fine.

    Args:
        tasks: Every task that an edge names, and perhaps others.
        edges: Pairs of producing and consuming task.
    """
    followers: dict[str, list[str]] = {task: [] for task in tasks}
    unmet = dict.fromkeys(followers, 0)
    for source, target in edges:
        followers[source].append(target)
        unmet[target] += 1
    free = [task for task, count in unmet.items() if count == 0]
    for task in free:
        for follower in followers[task]:
            unmet[follower] -= 1
            if unmet[follower] == 0:
                free.append(follower)
    stuck = {task: None for task, count in unmet.items() if count > 0}
    return _walk_back_to_a_repeat(edges, stuck) if stuck else []


def _walk_back_to_a_repeat(
    edges: Iterable[tuple[str, str]], stuck: Mapping[str, None]
) -> list[str]:
    """Return a cycle among tasks that each wait for another of them."""
    waits_for: dict[str, str] = {}
    for source, target in edges:
        if source in stuck and target in stuck:
            waits_for.setdefault(target, source)
    at = next(iter(stuck))
    trail: dict[str, None] = {}
    while at not in trail:
        trail[at] = None
        at = waits_for[at]
    walked = list(trail)
    backwards = walked[walked.index(at) :]
    return [at, *reversed(backwards)]


def _check_tasks(dag: DAG) -> None:
    seen: set[TaskId] = set()
    for task in dag.tasks:
        if task.id in seen:
            raise ScenarioError(f"DAG {dag.id!r}: task {task.id!r} is given twice")
        seen.add(task.id)
        if not is_quantity(task.compute_cost):
            raise ScenarioError(
                f"DAG {dag.id!r}, task {task.id!r}: compute_cost must be from 0 to "
                f"{MAX_QUANTITY:g}, not {task.compute_cost!r}"
            )


def _check_dependencies(dag: DAG) -> None:
    known = {task.id for task in dag.tasks}
    seen: set[tuple[TaskId, TaskId]] = set()
    for dependency in dag.dependencies:
        ends = (dependency.source, dependency.target)
        label = f"DAG {dag.id!r}, edge {ends[0]!r} -> {ends[1]!r}"
        for end in ends:
            if end not in known:
                raise ScenarioError(f"{label}: there is no task {end!r}")
        if ends in seen:
            raise ScenarioError(f"{label} is given twice")
        seen.add(ends)
        if not is_quantity(dependency.data_size_MB):
            raise ScenarioError(
                f"{label}: data_size must be from 0 to {MAX_QUANTITY:g}, "
                f"not {dependency.data_size_MB!r}"
            )
