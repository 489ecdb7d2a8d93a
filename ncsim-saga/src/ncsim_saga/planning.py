"""One plan by one SAGA scheduler: what it is asked, and how it is made.

A request says all that the answer depends on, and travels to a child process as JSON.
"""

import gc
import json
import random
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING

from ncsim_core.errors import PlacementError
from ncsim_core.workflow import DAG, DagId, Dependency, Task, TaskId

from ncsim_saga.catalogue import SCHEDULERS
from ncsim_saga.translate import saga_network, saga_task_graph
from ncsim_saga.virtual_network import VirtualNetwork, node_name

if TYPE_CHECKING:
    import saga


@dataclass(frozen=True)
class PlanRequest:
    """Everything that one plan depends on.

    Args:
        scheduler: A name of the catalogue.
        network: What SAGA sees of the network.
        dag: The tasks; pins are left out.
        options: Keyword arguments of SAGA's class.
        seed: Seeds the global generator for schedulers that draw.
    """

    scheduler: str
    network: VirtualNetwork
    dag: DAG
    options: Mapping[str, object] = field(default_factory=dict)
    seed: int = 0

    def to_json(self) -> str:
        """Return the request as one line; numbers come back exactly."""
        dag = self.dag
        return json.dumps(
            {
                "scheduler": self.scheduler,
                "capacities": self.network.capacities,
                "speed_MBps": self.network.speed_MBps,
                "dag": dag.id,
                "tasks": [(task.id, task.compute_cost) for task in dag.tasks],
                "dependencies": [
                    (each.source, each.target, each.data_size_MB) for each in dag.dependencies
                ],
                "options": dict(self.options),
                "seed": self.seed,
            }
        )

    @classmethod
    def from_json(cls, line: str) -> "PlanRequest":
        """Return the request that ``to_json`` wrote."""
        data = json.loads(line)
        return cls(
            data["scheduler"],
            VirtualNetwork(tuple(data["capacities"]), tuple(map(tuple, data["speed_MBps"]))),
            DAG(
                DagId(data["dag"]),
                tuple(Task(TaskId(name), cost) for name, cost in data["tasks"]),
                tuple(Dependency(*each) for each in data["dependencies"]),
            ),
            data["options"],
            data["seed"],
        )


def plan_with_saga(request: PlanRequest) -> dict[TaskId, int]:
    """Return the node index of every task, by SAGA, in this process.

    Raises:
        PlacementError: SAGA gave up, or left tasks out of its schedule (SPEC 23).
    """
    with _as_if_first(request):
        try:
            schedule = _schedule(request)
        except Exception as error:
            raise PlacementError(
                f"{_blamed(request)} gave up on DAG {request.dag.id!r}: "
                f"{type(error).__name__}: {error}"
            ) from error
    return _placement(schedule, request)


def _schedule(request: PlanRequest) -> "saga.Schedule":
    import saga.schedulers

    scheduler = getattr(saga.schedulers, SCHEDULERS[request.scheduler].saga_class)
    return scheduler(**request.options).schedule(
        saga_network(request.network), saga_task_graph(request.dag)
    )


def _placement(schedule: "saga.Schedule", request: PlanRequest) -> dict[TaskId, int]:
    index = {node_name(each): each for each in range(len(request.network))}
    found = {task.name: index[node] for node, tasks in schedule.items() for task in tasks}
    missing = [task.id for task in request.dag.tasks if task.id not in found]
    if missing:
        raise PlacementError(
            f"{_blamed(request)} left tasks of DAG {request.dag.id!r} out of its plan: "
            f"{', '.join(map(repr, missing))}; choose another scheduler"
        )
    return {task.id: found[task.id] for task in request.dag.tasks}


def _blamed(request: PlanRequest) -> str:
    return f"scheduler {request.scheduler} (anrg-saga {version('anrg-saga')})"


@contextmanager
def _as_if_first(request: PlanRequest) -> Iterator[None]:
    """Keep earlier plans from touching this one, and this one from touching the process.

    SAGA remembers ranks of equal instances although their sets may be walked in another order,
    pySMT numbers its terms over the life of the process, and WBA draws from the global ``random``.
    SMT's answer depends on when its solver's terms are thrown away, so collecting garbage waits:
    when it is due depends on all that the process did before, the compiling of modules included.
    """
    from saga.schedulers import cpop

    solver_terms = import_module("pysmt.environment")  # untyped; always there with SAGA
    drawn_before = random.getstate()
    random.seed(request.seed)
    solver_terms.push_env()
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()
        solver_terms.pop_env()
        random.setstate(drawn_before)
        cpop.upward_rank.cache_clear()
        cpop.cpop_ranks.cache_clear()
