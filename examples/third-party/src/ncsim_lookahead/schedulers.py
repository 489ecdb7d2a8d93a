"""Schedulers of ncsim-lookahead."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ncsim_core.context import BuildContext
from ncsim_core.contracts.scheduler import NetworkSnapshot, Scheduler
from ncsim_core.network import NodeIndex
from ncsim_core.workflow import DAG, Dependency, PlacementPlan, Task, TaskId
from typing_extensions import override


@dataclass
class _Draft:
    """A plan in the making: where tasks are, when they end, when nodes are free; seconds."""

    node_free_s: list[float]
    node_of: dict[TaskId, NodeIndex] = field(default_factory=dict)
    end_s: dict[TaskId, float] = field(default_factory=dict)


class Lookahead(Scheduler):
    """Puts each task where it and then its best-placed follower would end first.

    Tasks are planned in the order in which their inputs are known, ties in file order. A
    transfer over several hops is charged for each of them, since the hops of a wireless route
    take turns on the air: time = (latency + size / bottleneck) * (1 + hop_weight * (hops - 1)).

    Args:
        context: Not needed; every component is built with it.
        hop_weight: What each hop after the first adds to a transfer, as a part of its time.
    """

    def __init__(self, context: BuildContext, hop_weight: float = 1.0) -> None:
        del context
        self._hop_weight = hop_weight

    @override
    def schedule(self, dag: DAG, snapshot: NetworkSnapshot) -> PlacementPlan:
        nodes = snapshot.network.nodes
        draft = _Draft([0.0] * len(nodes))
        for task in in_order(dag):
            candidates: Sequence[NodeIndex] = range(len(nodes))
            if task.pinned_to is not None:
                candidates = [snapshot.network.node_index[task.pinned_to]]
            node = min(candidates, key=lambda each: self._rank(task, each, dag, snapshot, draft))
            draft.end_s[task.id] = self._end_s(task, node, dag, snapshot, draft)
            draft.node_of[task.id] = node
            draft.node_free_s[node] = draft.end_s[task.id]
        return PlacementPlan({task: nodes[node].id for task, node in draft.node_of.items()})

    def _rank(
        self, task: Task, node: NodeIndex, dag: DAG, snapshot: NetworkSnapshot, draft: _Draft
    ) -> tuple[float, float, str]:
        """Return what to minimise: the follower's end, the task's own end, the node's id."""
        end_s = self._end_s(task, node, dag, snapshot, draft)
        followers_end_s = max(
            (
                self._follower_end_s(each, node, end_s, dag, snapshot)
                for each in dag.outgoing[task.id]
            ),
            default=end_s,
        )
        return followers_end_s, end_s, snapshot.network.nodes[node].id

    def _end_s(
        self, task: Task, node: NodeIndex, dag: DAG, snapshot: NetworkSnapshot, draft: _Draft
    ) -> float:
        inputs_s = [
            draft.end_s[each.source]
            + self.transfer_s(each.data_size_MB, draft.node_of[each.source], node, snapshot)
            for each in dag.incoming[task.id]
        ]
        start_s = max([draft.node_free_s[node], *inputs_s])
        return start_s + task.compute_cost / snapshot.network.nodes[node].compute_capacity

    def _follower_end_s(
        self,
        dependency: Dependency,
        node: NodeIndex,
        end_s: float,
        dag: DAG,
        snapshot: NetworkSnapshot,
    ) -> float:
        """Return when a follower would end on the node that is best for it, all else ignored."""
        follower = dag.tasks[dag.task_index[dependency.target]]
        return min(
            end_s
            + self.transfer_s(dependency.data_size_MB, node, other, snapshot)
            + follower.compute_cost / snapshot.network.nodes[other].compute_capacity
            for other in range(len(snapshot.network.nodes))
        )

    def transfer_s(
        self, size_MB: float, source: NodeIndex, target: NodeIndex, snapshot: NetworkSnapshot
    ) -> float:
        """Return the planned time of a transfer in seconds; infinite without a route."""
        if source == target:
            return 0.0
        route = snapshot.routes.route(source, target)
        if route is None:
            return math.inf
        alone_s = snapshot.transfer_time_s(size_MB, source, target)
        return alone_s * (1.0 + self._hop_weight * (len(route) - 1))


def in_order(dag: DAG) -> list[Task]:
    """Return the tasks so that each follows all that it waits for; file order where free."""
    unmet = {task: len(inputs) for task, inputs in dag.incoming.items()}
    free = [task for task in dag.tasks if unmet[task.id] == 0]
    tasks: Mapping[TaskId, Task] = {task.id: task for task in dag.tasks}
    for task in free:
        for dependency in dag.outgoing[task.id]:
            unmet[dependency.target] -= 1
            if unmet[dependency.target] == 0:
                free.append(tasks[dependency.target])
    return free
