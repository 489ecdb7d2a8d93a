"""The adapter: any scheduler of the catalogue as a scheduler of ncsim.

Only placements are kept; the order of tasks on a node is the engine's business.

Source: Section IV-D of the paper; SPEC 20 to 23.
"""

from ncsim_core.context import BuildContext
from ncsim_core.contracts.scheduler import NetworkSnapshot, Scheduler
from ncsim_core.workflow import DAG, PlacementPlan
from typing_extensions import override

from ncsim_saga.catalogue import SCHEDULERS
from ncsim_saga.virtual_network import virtual_network


class SagaScheduler(Scheduler):
    """Asks one SAGA scheduler, here or in a child process.

    Args:
        context: Gives the seed for schedulers that draw.
        name: A name of the catalogue.
        options: Keyword arguments of SAGA's class.
    """

    def __init__(self, context: BuildContext, *, name: str, **options: object) -> None:
        self._entry = SCHEDULERS[name]
        self._options = options
        self._seed = context.seed

    @override
    def schedule(self, dag: DAG, snapshot: NetworkSnapshot) -> PlacementPlan:
        if not dag.tasks:
            return PlacementPlan()
        from ncsim_saga.planning import PlanRequest, plan_with_saga
        from ncsim_saga.worker import plan_in_child

        request = PlanRequest(
            self._entry.name, virtual_network(snapshot), dag, self._options, self._seed
        )
        plan = plan_in_child if self._entry.is_planned_in_child else plan_with_saga
        nodes = snapshot.network.nodes
        return PlacementPlan({task: nodes[index].id for task, index in plan(request).items()})
