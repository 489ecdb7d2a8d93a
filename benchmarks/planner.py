"""How fast plans are made: ncsim's own HEFT and CPOP against SAGA's.

CPU time of one plan, the least of several. Networks are complete, with two link speeds; DAGs
are layered, each task with three parents in the layer above. ``first`` is what the first plan on
a network pays once (order of virtual links), ``plan`` what every plan pays.

    python benchmarks/planner.py [--saga-up-to TASKS]
    python benchmarks/planner.py --only NODES TASKS    # median of 5 plans by HEFT alone
"""

import argparse
import random
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import TypeVar

from ncsim_core.workflow import DAG, DagId, Dependency, Task, TaskId
from ncsim_saga.native.cpop import cpop
from ncsim_saga.native.heft import heft
from ncsim_saga.native.instance import Instance, instance_of
from ncsim_saga.native.planning_network import PlanningNetwork, planning_network
from ncsim_saga.native.processors import Processors
from ncsim_saga.planning import PlanRequest, plan_with_saga
from ncsim_saga.schedulers.native_scheduler import processors_for
from ncsim_saga.virtual_network import SAME_NODE_MBps, VirtualNetwork
from timing import cpu_median_s

T = TypeVar("T")
Algorithm = Callable[[Instance, Processors], list[int]]

ALGORITHMS: dict[str, Algorithm] = {"heft": heft, "cpop": cpop}
CAPACITIES = (200, 100, 150, 80, 300, 120, 250, 180, 160, 90, 220, 140, 280, 110, 190, 170)
SPEEDS_MBps = (3.319052987598648, 2.6011662837957235)
TARGETS_s = {(16, 20): 0.001, (100, 1_000): 0.3, (400, 10_000): 3.0}
PARENTS = 3


@dataclass(frozen=True)
class Case:
    """One size of problem.

    Args:
        nodes: Nodes of the network.
        tasks: Tasks of the DAG.
        width: Tasks per layer.
        has_ties: Whether all costs are equal and all sizes, or all different.
        repeats: How many plans are timed.
    """

    nodes: int
    tasks: int
    width: int
    has_ties: bool
    repeats: int

    def network(self) -> VirtualNetwork:
        """Return a complete network."""
        draw = random.Random(self.nodes)
        everyone = range(self.nodes)
        return VirtualNetwork(
            tuple(float(CAPACITIES[node % len(CAPACITIES)]) for node in everyone),
            tuple(
                tuple(SAME_NODE_MBps if a == b else draw.choice(SPEEDS_MBps) for b in everyone)
                for a in everyone
            ),
        )

    def dag(self) -> DAG:
        """Return a layered DAG."""
        draw = random.Random(self.tasks)

        def number(tied: float, low: float, high: float) -> float:
            return tied if self.has_ties else draw.uniform(low, high)

        names = [TaskId(f"T{task}") for task in range(self.tasks)]
        dependencies = [
            Dependency(names[parent], names[child], number(10.0, 1.0, 20.0))
            for child in range(self.width, self.tasks)
            for above in [(child // self.width - 1) * self.width]
            for parent in draw.sample(range(above, above + self.width), PARENTS)
        ]
        tasks = [Task(name, number(500.0, 100.0, 1_000.0)) for name in names]
        return DAG(DagId("layered"), tuple(tasks), tuple(dependencies))


CASES = [
    Case(nodes, tasks, width, has_ties, repeats)
    for nodes, tasks, width, repeats in (
        (16, 20, 5, 50),
        (16, 100, 10, 10),
        (100, 100, 20, 5),
        (100, 1_000, 40, 5),
        (400, 10_000, 100, 2),
        (400, 10_000, 1_000, 2),
    )
    for has_ties in (True, False)
]


def timed(make: Callable[[], T], repeats: int = 1) -> tuple[T, float]:
    """Return the last result and the least CPU time (s) of several calls."""
    least_s, result = float("inf"), None
    for _ in range(repeats):
        started_s = time.process_time()
        result = make()
        least_s = min(least_s, time.process_time() - started_s)
    return result, least_s  # type: ignore[return-value]  # repeats is at least 1


def native_plan(name: str, dag: DAG, network: PlanningNetwork) -> list[int]:
    """Return the node of every task, in file order, the DAG read anew."""
    instance = instance_of.__wrapped__(dag)  # not the one that is remembered
    processors = processors_for(network, min(instance.costs))
    return [network.nodes[position] for position in ALGORITHMS[name](instance, processors)]


def measure(case: Case, saga_up_to: int) -> None:
    """Print one row for each algorithm."""
    dag = case.dag()
    virtual = case.network()
    network, first_s = timed(lambda: planning_network(virtual))
    for name in ALGORITHMS:
        ours, native_s = timed(partial(native_plan, name, dag, network), case.repeats)
        saga = ""
        if case.tasks * case.nodes <= saga_up_to:
            theirs, saga_s = timed(partial(plan_with_saga, PlanRequest(name, virtual, dag)))
            same = [theirs[task.id] for task in dag.tasks] == ours
            saga = f"{saga_s * 1e3:10.1f} {saga_s / native_s:8.0f}  {'same' if same else 'DIFFER'}"
        target_s = TARGETS_s.get((case.nodes, case.tasks)) if name == "heft" else None
        target = "" if target_s is None else f"{target_s * 1e3:8.0f}"
        print(
            f"{name} {case.nodes:6} {case.tasks:7} {case.width:6} "
            f"{'equal' if case.has_ties else 'drawn':>6} {first_s * 1e3:9.1f} "
            f"{native_s * 1e3:9.2f} {target:>8} {saga}",
            flush=True,
        )


def measure_heft(nodes: int, tasks: int) -> None:
    """Print the median time of a plan by HEFT, all costs and sizes different."""
    case = next(
        each for each in CASES if (each.nodes, each.tasks) == (nodes, tasks) and not each.has_ties
    )
    dag, network = case.dag(), planning_network(case.network())
    native_plan("heft", dag, network)
    print(f"heft {cpu_median_s(lambda: native_plan('heft', dag, network)):.5f} s")


def main() -> None:
    """Measure all cases."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument(
        "--saga-up-to",
        type=int,
        default=10_000,
        help="largest tasks x nodes for which SAGA is asked as well (default: %(default)s)",
    )
    parser.add_argument("--only", nargs=2, type=int, metavar=("NODES", "TASKS"))
    options = parser.parse_args()
    if options.only:
        measure_heft(*options.only)
        return
    import_module("saga.schedulers")  # not part of any plan
    print("plan    nodes   tasks  width  sizes  first ms   plan ms   target    SAGA ms    ratio")
    for case in CASES:
        measure(case, options.saga_up_to)


if __name__ == "__main__":
    main()
