"""Heterogeneous earliest finish time over a table of transfer times.

Source: Topcuoglu, Hariri and Wu, IEEE TPDS 13(3), 2002 (the paper's reference ``heft``).
"""

from bisect import insort
from collections.abc import Sequence
from dataclasses import dataclass

from ncsim_core.network import NodeId, NodeIndex
from ncsim_core.workflow import DAG, Dependency, PlacementPlan, Task, TaskId

UNREACHABLE_s_per_MB = 1000.0  # 0.001 MB/s, as SAGA's virtual network has it (SPEC 21)


@dataclass(frozen=True)
class PlanningNetwork:
    """Nodes and what a transfer between two of them takes.

    Args:
        node_ids: Ids in file order.
        capacities: Compute units per second of each node.
        s_per_MB: Inverse rate by (source, target), 0 from a node to itself.
        latency_s: Latency by (source, target).
    """

    node_ids: Sequence[NodeId]
    capacities: Sequence[float]
    s_per_MB: Sequence[Sequence[float]]
    latency_s: Sequence[Sequence[float]]

    def transfer_s(self, size_MB: float, source: NodeIndex, target: NodeIndex) -> float:
        """Return how long a transfer takes that is alone."""
        return self.latency_s[source][target] + size_MB * self.s_per_MB[source][target]


@dataclass(frozen=True)
class Slot:
    """When and where a task is planned to run."""

    node: NodeIndex
    start_s: float
    end_s: float


def heft_plan(dag: DAG, network: PlanningNetwork) -> PlacementPlan:
    """Return HEFT's placement, with insertion; pinned tasks go where they are pinned.

    Equal ranks keep file order, equal finish times take the first node in file order.
    """
    ranks = upward_ranks(dag, network)
    order = sorted(dag.tasks, key=lambda task: -ranks[task.id])
    timelines: list[list[tuple[float, float]]] = [[] for _ in network.node_ids]
    slots: dict[TaskId, Slot] = {}
    for task in _parents_first(order, dag):
        inputs = dag.incoming[task.id]
        choices = [
            _slot(task, node, inputs, slots, timelines[node], network)
            for node in _candidates(task, network)
        ]
        best = min(choices, key=lambda slot: slot.end_s)
        slots[task.id] = best
        insort(timelines[best.node], (best.start_s, best.end_s))
    return PlacementPlan({task.id: network.node_ids[slots[task.id].node] for task in dag.tasks})


def upward_ranks(dag: DAG, network: PlanningNetwork) -> dict[TaskId, float]:
    """Return for each task the mean length of the longest path from it to an exit.

    Means run over all nodes for tasks and over ordered pairs of different nodes for transfers.
    """
    nodes = range(len(network.node_ids))
    mean_s_per_cost = sum(1.0 / capacity for capacity in network.capacities) / len(nodes)
    pairs = [(a, b) for a in nodes for b in nodes if a != b]
    count = max(1, len(pairs))
    mean_s_per_MB = sum(network.s_per_MB[a][b] for a, b in pairs) / count
    mean_latency_s = sum(network.latency_s[a][b] for a, b in pairs) / count
    ranks: dict[TaskId, float] = {}
    for task in reversed(topological(dag)):
        tails = [
            mean_latency_s + each.data_size_MB * mean_s_per_MB + ranks[each.target]
            for each in dag.outgoing[task.id]
        ]
        ranks[task.id] = task.compute_cost * mean_s_per_cost + max(tails, default=0.0)
    return ranks


def topological(dag: DAG) -> list[Task]:
    """Return the tasks in an order in which every task follows its inputs."""
    return list(_parents_first(dag.tasks, dag))


def _parents_first(order: Sequence[Task], dag: DAG) -> list[Task]:
    """Return tasks in the given order, except that none precedes one of its inputs."""
    place = {task.id: number for number, task in enumerate(order)}
    waiting = {task.id: len(dag.incoming[task.id]) for task in order}
    free = sorted(place[task_id] for task_id, count in waiting.items() if count == 0)
    arranged = []
    while free:
        task = order[free.pop(0)]
        arranged.append(task)
        for each in dag.outgoing[task.id]:
            waiting[each.target] -= 1
            if waiting[each.target] == 0:
                insort(free, place[each.target])
    return arranged


def _candidates(task: Task, network: PlanningNetwork) -> Sequence[NodeIndex]:
    if task.pinned_to is not None and task.pinned_to in network.node_ids:
        return [network.node_ids.index(task.pinned_to)]
    return range(len(network.node_ids))


def _slot(
    task: Task,
    node: NodeIndex,
    inputs: Sequence[Dependency],
    slots: dict[TaskId, Slot],
    timeline: list[tuple[float, float]],
    network: PlanningNetwork,
) -> Slot:
    """Return the earliest slot of a task on a node: inputs there, gap long enough."""
    ready_s = max(
        (
            slots[each.source].end_s
            + network.transfer_s(each.data_size_MB, slots[each.source].node, node)
            for each in inputs
        ),
        default=0.0,
    )
    duration_s = task.compute_cost / network.capacities[node]
    start_s = earliest_gap_s(timeline, ready_s, duration_s)
    return Slot(node, start_s, start_s + duration_s)


def earliest_gap_s(
    timeline: Sequence[tuple[float, float]], ready_s: float, duration_s: float
) -> float:
    """Return when a task fits between those already planned on a node.

    >>> earliest_gap_s([(0.0, 2.0), (5.0, 6.0)], 1.0, 3.0)
    2.0
    >>> earliest_gap_s([(0.0, 2.0), (5.0, 6.0)], 1.0, 4.0)
    6.0
    """
    start_s = ready_s
    for busy_from_s, busy_until_s in timeline:
        if start_s + duration_s <= busy_from_s:
            break
        start_s = max(start_s, busy_until_s)
    return start_s
