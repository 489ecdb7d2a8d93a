"""Layered DAGs of 100 to 1,000 tasks on grids of 25 to 100 nodes, under three radio models.

    python examples/spatial/scale.py            # all sizes
    python examples/spatial/scale.py 25 100     # one: nodes, tasks

Tasks in layers of about the square root of their number, one to three parents each, cost 500 units,
payload 10 MB, HEFT, minimum-hop routes; findings are in ``README.md`` beside it.
"""

import math
import random
import sys
import time
from itertools import product

from ncsim_core import simulate
from ncsim_core.generators.dags import Form, dag_of
from ncsim_core.generators.paper import paper_grid
from ncsim_core.scenario.making import make_scenario
from ncsim_core.workflow import DAG

NODES = (25, 49, 100)
TASKS = (100, 300, 1000)
MODELS = ("none", "csma_bianchi", "csma_spatial")
MOST_PARENTS = 3


def layered_dag(tasks: int) -> DAG:
    """Return tasks in layers, each below the first with one to three parents above it."""
    width = round(math.sqrt(tasks))
    draw = random.Random(42)
    edges = []
    for task in range(width, tasks):
        above = (task // width - 1) * width
        parents = draw.sample(range(width), draw.randint(1, MOST_PARENTS))
        edges += [(f"T{above + parent}", f"T{task}") for parent in sorted(parents)]
    return dag_of(Form([f"T{number}" for number in range(tasks)], edges))


def report(nodes: int, tasks: int, model: str) -> str:
    """Run one size under one model, and return a line about it."""
    config = {
        "scheduler": "heft",
        "routing": "minimum_hop",
        "link_model": "wifi",
        "interference": model,
    }
    grid = paper_grid(math.isqrt(nodes))
    began_s = time.process_time()
    result = simulate(make_scenario("scale", grid, [layered_dag(tasks)], config))
    took_s = time.process_time() - began_s
    makespan = "-" if result.makespan_s is None else f"{result.makespan_s:.1f} s"
    return f"{nodes:4d} {tasks:5d} {model:13s} {result.status:17s} {makespan:>12s} {took_s:8.2f} s"


def main() -> None:
    """Print status, makespan and CPU time of each run."""
    chosen = [int(each) for each in sys.argv[1:3]]
    sizes = [tuple(chosen)] if chosen else list(product(NODES, TASKS))
    sys.stdout.write("nodes tasks model       status              makespan      CPU\n")
    for nodes, tasks in sizes:
        for model in MODELS:
            sys.stdout.write(report(nodes, tasks, model) + "\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
