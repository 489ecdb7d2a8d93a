"""Numbers instead of names: tasks and dependencies of all DAGs of a run.

They are numbered through, in order of injection and then of the file, so that the engine works on
lists. Runs that have their DAGs in common share the numbers.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import repeat
from typing import Final, NamedTuple

from ncsim_core.context import ModelCache
from ncsim_core.workflow import DAG, Task

NUMBERINGS: Final = ModelCache(max_entries=8, max_weight=1_000_000)
"""By identity of the DAGs, as comparing large ones takes as long as numbering them; weighed by
their tasks and dependencies."""


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
class Numbering:
    """All tasks and dependencies of a run by number.

    Args:
        dags: Whose they are.
        tasks: All tasks.
        dependencies: All dependencies.
        first_task: By DAG, the number of its first task.
        first_dependency: By DAG, the number of its first dependency.
    """

    dags: tuple[DAG, ...]
    tasks: tuple[TaskEntry, ...]
    dependencies: tuple[DependencyEntry, ...]
    first_task: tuple[int, ...]
    first_dependency: tuple[int, ...]


def numbering_of(dags: Sequence[DAG]) -> Numbering:
    """Return the numbering of DAGs, the one that an earlier run has if it had these very DAGs."""
    weight = sum(len(dag.tasks) + len(dag.dependencies) for dag in dags)
    identities = tuple(map(id, dags))  # of objects that live as long as what is kept
    return NUMBERINGS.get_or_build(identities, lambda: _numbered(tuple(dags)), weight)


def _numbered(dags: tuple[DAG, ...]) -> Numbering:
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
    return Numbering(dags, tuple(tasks), tuple(dependencies), first_task, first_dependency)


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
