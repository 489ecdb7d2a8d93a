"""A DAG as the native planners read it: dense indices, and SAGA's two orders of tasks."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

from ncsim_core.workflow import DAG

from ncsim_saga.hash_order import name_hash, pair_hash, walking_order

MAX_REMEMBERED_DAGS = 8

Neighbours: TypeAlias = tuple[tuple[int, float], ...]
"""Tasks on the other end of a dependency, with its size in MB."""


@dataclass(frozen=True)
class Instance:
    """Tasks by their index in the file.

    Args:
        names: Task ids.
        costs: Compute units.
        parents: For each task, what it waits for.
        children: For each task, what waits for it.
        walk: All tasks in the order in which SAGA walks its set of tasks.
        topological: All tasks, parents first, in the order that networkx gives SAGA.
    """

    names: tuple[str, ...]
    costs: tuple[float, ...]
    parents: tuple[Neighbours, ...]
    children: tuple[Neighbours, ...]
    walk: tuple[int, ...]
    topological: tuple[int, ...]


@lru_cache(maxsize=MAX_REMEMBERED_DAGS)
def instance_of(dag: DAG) -> Instance:
    """Return a DAG as the native planners read it; the runs of a study ask for the same few."""
    names = tuple(task.id for task in dag.tasks)
    parents: list[list[tuple[int, float]]] = [[] for _ in names]
    children: list[list[tuple[int, float]]] = [[] for _ in names]
    for at in walking_order(pair_hash(each.source, each.target) for each in dag.dependencies):
        each = dag.dependencies[at]
        source, target = dag.task_index[each.source], dag.task_index[each.target]
        size_MB = float(each.data_size_MB)
        children[source].append((target, size_MB))
        parents[target].append((source, size_MB))
    walk = walking_order(map(name_hash, names))
    return Instance(
        names,
        tuple(float(task.compute_cost) for task in dag.tasks),
        tuple(map(tuple, parents)),
        tuple(map(tuple, children)),
        tuple(walk),
        tuple(_topological(walk, children, [len(each) for each in parents])),
    )


def _topological(
    walk: Sequence[int], children: Sequence[Sequence[tuple[int, float]]], unmet: list[int]
) -> list[int]:
    """Return tasks in networkx's topological order: first free, first out."""
    order = [task for task in walk if unmet[task] == 0]
    for task in order:
        for child, _ in children[task]:
            unmet[child] -= 1
            if unmet[child] == 0:
                order.append(child)
    return order
