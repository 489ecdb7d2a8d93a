"""Schedulers that need no planning."""

from typing_extensions import override

from ncsim_core.context import BuildContext
from ncsim_core.contracts.scheduler import NetworkSnapshot, Scheduler
from ncsim_core.errors import ScenarioError
from ncsim_core.workflow import DAG, PlacementPlan


class ManualScheduler(Scheduler):
    """Places every task where ``pinned_to`` says."""

    def __init__(self, context: BuildContext) -> None:
        del context

    @override
    def schedule(self, dag: DAG, snapshot: NetworkSnapshot) -> PlacementPlan:
        unpinned = [task.id for task in dag.tasks if task.pinned_to is None]
        if unpinned:
            names = ", ".join(map(repr, unpinned))
            raise ScenarioError(
                f"scheduler manual: DAG {dag.id!r} has tasks without pinned_to: {names}; "
                "pin each of them or choose another scheduler"
            )
        return PlacementPlan(
            {task.id: task.pinned_to for task in dag.tasks if task.pinned_to is not None}
        )


class RoundRobinScheduler(Scheduler):
    """Deals unpinned tasks out to the nodes in turn, both in file order.

    A pinned task takes its node and does not move the turn, which goes on from DAG to DAG.
    """

    def __init__(self, context: BuildContext) -> None:
        del context

    @override
    def schedule(self, dag: DAG, snapshot: NetworkSnapshot) -> PlacementPlan:
        nodes = snapshot.network.nodes
        turn = snapshot.free_tasks_placed
        plan = {}
        for task in dag.tasks:
            if task.pinned_to is not None:
                plan[task.id] = task.pinned_to
            else:
                plan[task.id] = nodes[turn % len(nodes)].id
                turn += 1
        return PlacementPlan(plan)


class AllOnFastestScheduler(Scheduler):
    """Puts every task on the node with the greatest capacity; the first listed if several tie.

    Without pins nothing is sent at all: the baseline that any use of the network must beat.
    """

    def __init__(self, context: BuildContext) -> None:
        del context

    @override
    def schedule(self, dag: DAG, snapshot: NetworkSnapshot) -> PlacementPlan:
        fastest = max(snapshot.network.nodes, key=lambda node: node.compute_capacity)
        return PlacementPlan({task.id: task.pinned_to or fastest.id for task in dag.tasks})
