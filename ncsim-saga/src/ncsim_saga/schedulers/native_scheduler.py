"""HEFT and CPOP, by ncsim's own planner or by SAGA's.

Source: Section IV-D of the paper; SPEC 20 to 22.
"""

from typing import Literal

from ncsim_core.context import BuildContext
from ncsim_core.contracts.scheduler import NetworkSnapshot, Scheduler
from ncsim_core.workflow import DAG, PlacementPlan
from typing_extensions import override

from ncsim_saga.native.planning_network import MANY_NODES, PlanningNetwork, planning_network
from ncsim_saga.native.processors import ListProcessors, Processors
from ncsim_saga.schedulers.saga_scheduler import SagaScheduler
from ncsim_saga.virtual_network import virtual_network


class NativeScheduler(Scheduler):
    """Plans as SAGA does, placement for placement, without importing it.

    Args:
        context: Passed on to SAGA's adapter.
        name: ``heft`` or ``cpop``.
        engine: ``native``, ``saga``, or ``auto``, which is native.
    """

    def __init__(
        self,
        context: BuildContext,
        *,
        name: Literal["heft", "cpop"],
        engine: Literal["auto", "native", "saga"] = "auto",
    ) -> None:
        self._name = name
        self._saga = SagaScheduler(context, name=name) if engine == "saga" else None

    @override
    def schedule(self, dag: DAG, snapshot: NetworkSnapshot) -> PlacementPlan:
        if self._saga is not None:
            return self._saga.schedule(dag, snapshot)
        if not dag.tasks:
            return PlacementPlan()
        network = planning_network(virtual_network(snapshot))
        positions = self._plan(dag, network)
        nodes = snapshot.network.nodes
        return PlacementPlan(
            {
                task.id: nodes[network.nodes[position]].id
                for task, position in zip(dag.tasks, positions, strict=True)
            }
        )

    def _plan(self, dag: DAG, network: PlanningNetwork) -> list[int]:
        from ncsim_saga.native.cpop import cpop
        from ncsim_saga.native.heft import heft
        from ncsim_saga.native.instance import instance_of

        instance = instance_of(dag)
        algorithm = heft if self._name == "heft" else cpop
        return algorithm(instance, processors_for(network, min(instance.costs)))


def processors_for(network: PlanningNetwork, least_cost: float) -> Processors:
    """Return the faster of the two implementations for a network's size."""
    if len(network.nodes) < MANY_NODES:
        return ListProcessors(network, least_cost)
    from ncsim_saga.native.array_processors import ArrayProcessors

    return ArrayProcessors(network, least_cost)
