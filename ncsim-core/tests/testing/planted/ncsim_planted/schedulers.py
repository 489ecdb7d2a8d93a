"""Schedulers that break their contract."""

from ncsim_core.builtin.schedulers import RoundRobinScheduler
from ncsim_core.workflow import PlacementPlan

LARGE_COST = 1000


class PlanIsTotal(RoundRobinScheduler):
    def schedule(self, dag, snapshot):
        plan = super().schedule(dag, snapshot)
        return PlacementPlan(dict(list(plan.nodes.items())[:4]))


class PlannedNodesExist(RoundRobinScheduler):
    def schedule(self, dag, snapshot):
        return PlacementPlan({task.id: f"n{number}" for number, task in enumerate(dag.tasks)})


class ExtremesArePlanned(RoundRobinScheduler):
    def schedule(self, dag, snapshot):
        bandwidths = snapshot.network.bandwidth_MBps
        assert sum(bandwidths) / len(bandwidths) >= 0
        return super().schedule(dag, snapshot)


class ScalingChangesNothing(RoundRobinScheduler):
    def schedule(self, dag, snapshot):
        nodes = snapshot.network.nodes
        return PlacementPlan(
            {task.id: nodes[-(task.compute_cost > LARGE_COST)].id for task in dag.tasks}
        )
