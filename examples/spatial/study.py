"""The 108-run grid study under csma_spatial: rank inversions between Solo and Full, by model.

Run ``python examples/spatial/study.py``; findings are in ``README.md`` beside it.
"""

import sys
from itertools import product

from ncsim_core import simulate
from ncsim_core.generators.paper import paper_dag, paper_grid
from ncsim_core.scenario.making import make_scenario

SCHEDULERS = ("heft", "cpop", "round_robin")
ROUTINGS = ("widest_path", "minimum_hop")
MODELS = ("none", "csma_bianchi", "csma_spatial")


def makespan_s(grid: int, tasks: int, scheduler: str, routing: str, model: str) -> float:
    """Return the makespan of one run, infinite if it does not complete."""
    config = {
        "scheduler": scheduler,
        "routing": routing,
        "link_model": "wifi",
        "interference": model,
    }
    dag = paper_dag(tasks, payload_MB=10.0)
    result = simulate(make_scenario("study", paper_grid(grid), [dag], config))
    return float("inf") if result.makespan_s is None else result.makespan_s


def main() -> None:
    """Print one line per run of the study, and the best scheduler of each model and case."""
    for grid, tasks, routing in product((2, 3, 4), (5, 10, 20), ROUTINGS):
        best = {}
        for model in MODELS:
            spans_s = {each: makespan_s(grid, tasks, each, routing, model) for each in SCHEDULERS}
            best[model] = min(spans_s, key=spans_s.__getitem__)
            shown = " ".join(f"{name} {span_s:.3f}" for name, span_s in spans_s.items())
            sys.stdout.write(f"{grid}x{grid} {tasks:2d} {routing:12s} {model:12s} {shown}\n")
        sys.stdout.write(f"   best: {best}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
