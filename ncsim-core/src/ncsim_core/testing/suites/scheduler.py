"""Properties of schedulers."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import ClassVar, cast

from hypothesis.strategies import SearchStrategy
from typing_extensions import override

from ncsim_core.contracts.scheduler import Scheduler
from ncsim_core.errors import ScenarioError
from ncsim_core.network import Network
from ncsim_core.testing import builders, strategies
from ncsim_core.testing.checking import check
from ncsim_core.testing.questions import Case
from ncsim_core.testing.subject import Subject
from ncsim_core.testing.suites.base import ComponentSuite
from ncsim_core.workflow import DAG, PlacementPlan

SCALE = 4.0  # a power of two: scaling by it is exact
LEAST_TASKS = 3  # what every scheduler can be asked about


class SchedulerSuite(ComponentSuite):
    """Checks of a scheduler.

    Attributes:
        max_nodes: Nodes of drawn networks; lower it for schedulers that try every plan.
        max_tasks: Tasks of drawn DAGs; the capability ``max_tasks=`` lowers it as well.
    """

    kind = "scheduler"
    max_nodes: ClassVar[int] = 4
    max_tasks: ClassVar[int] = 6

    @override
    def cases(self) -> SearchStrategy[Case]:
        limit = self._most_tasks(self.subject())
        return strategies.instances(max_nodes=self.max_nodes, max_tasks=limit)

    @override
    def strategies(self) -> Mapping[str, SearchStrategy[object]]:
        limit = min(4, self._most_tasks(self.subject()))
        return {**super().strategies(), "run": strategies.runs(max_tasks=limit)}

    @override
    def ordinary_cases(self, subject: Subject) -> list[Case]:
        limit = self._most_tasks(subject)
        return [
            case
            for case in super().ordinary_cases(subject)
            if case.dag is not None and len(case.dag.tasks) <= max(limit, LEAST_TASKS)
        ]

    def _most_tasks(self, subject: Subject) -> int:
        """Return how many tasks to ask about: ``max_tasks=`` among the capabilities, or less."""
        return min(self.max_tasks, int(subject.capability("max_tasks") or self.max_tasks))

    @check()
    def check_plan_is_total(self, subject: Subject, case: Case) -> None:
        """The plan has every task of the DAG and no other."""
        assert case.dag is not None
        planned = set(_plan(subject, case).nodes)
        tasks = {task.id for task in case.dag.tasks}
        assert planned == tasks, f"missing {tasks - planned}, unknown {planned - tasks}"

    @check()
    def check_planned_nodes_exist(self, subject: Subject, case: Case) -> None:
        """The plan names nodes of the network only."""
        strangers = set(_plan(subject, case).nodes.values()) - set(case.network.node_index)
        assert not strangers, f"no such nodes: {strangers}"

    @check(is_drawn=False)
    def check_extremes_are_planned(self, subject: Subject) -> None:
        """One node, one task, no links, links without bandwidth, no data, no cost: a plan."""
        is_small = self._most_tasks(subject) <= LEAST_TASKS
        dag_like = partial(builders.chain, LEAST_TASKS) if is_small else builders.diamond
        extremes = {
            "one node, one task": (builders.line(1), builders.chain(1)),
            "one node, several tasks": (builders.line(1), dag_like()),
            "no links": (builders.scattered(3), dag_like()),
            "links without bandwidth": (builders.line(3, bandwidth_MBps=0.0), dag_like()),
            "no data": (builders.line(3), dag_like(size_MB=0.0)),
            "no cost": (builders.line(3), dag_like(cost=0.0)),
            "no dependencies": (builders.line(2), builders.dag_of((), tasks=LEAST_TASKS)),
        }
        for name, (network, dag) in extremes.items():
            case = subject.settle(Case(network, dag=dag))
            plan = _plan_of_any(subject, case)
            assert set(plan.nodes) == set(dag.task_index), f"{name}: {plan}"

    @check(capability="scale_invariant")
    def check_scaling_changes_nothing(self, subject: Subject, case: Case) -> None:
        """Costs and capacities multiplied by the same number leave the plan as it is."""
        assert case.dag is not None
        tasks = tuple(replace(t, compute_cost=SCALE * t.compute_cost) for t in case.dag.tasks)
        nodes = tuple(
            replace(n, compute_capacity=SCALE * n.compute_capacity) for n in case.network.nodes
        )
        network = replace(case.network, nodes=nodes)
        scaled = Case(network, dag=replace(case.dag, tasks=tasks))
        assert _plan(subject, scaled) == _plan(subject, case)


def _plan(subject: Subject, case: Case) -> PlacementPlan:
    assert case.dag is not None
    scheduler = cast("Scheduler", subject.build(case))
    plan = scheduler.schedule(case.dag, builders.make_snapshot(case.network))
    assert isinstance(plan, PlacementPlan), f"schedule() gave {plan!r}"
    return plan


def _plan_of_any(subject: Subject, case: Case) -> PlacementPlan:
    """Return the plan; a scheduler that wants pins is asked again with all tasks pinned."""
    try:
        return _plan(subject, case)
    except ScenarioError:
        return _plan(subject, replace(case, dag=_pinned(case.dag, case.network)))


def _pinned(dag: DAG | None, network: Network) -> DAG:
    assert dag is not None
    return replace(
        dag, tasks=tuple(replace(task, pinned_to=network.nodes[0].id) for task in dag.tasks)
    )
