"""The 108-run grid study under csma_spatial: rank inversions between Solo and Full, by model.

Run ``python examples/spatial/study.py``; findings are in ``README.md`` beside it.
"""

import sys
from collections.abc import Mapping
from itertools import combinations, product

from ncsim_core import simulate
from ncsim_core.generators.paper import paper_dag, paper_grid
from ncsim_core.scenario.making import make_scenario

SCHEDULERS = ("heft", "cpop", "round_robin")
ROUTINGS = ("widest_path", "minimum_hop")
SOLO, FULL = "none", ("csma_bianchi", "csma_spatial")


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


def inversions(solo: Mapping[str, float], full: Mapping[str, float]) -> list[str]:
    """Return the pairs of schedulers whose strict order in one is the opposite in the other."""
    return [
        f"{a}/{b}"
        for a, b in combinations(SCHEDULERS, 2)
        if (solo[a] - solo[b]) * (full[a] - full[b]) < 0
    ]


def main() -> None:
    """Print the makespans of each case, and what interference turns round under each model."""
    for grid, tasks, routing in product((2, 3, 4), (5, 10, 20), ROUTINGS):
        spans_s = {
            model: {each: makespan_s(grid, tasks, each, routing, model) for each in SCHEDULERS}
            for model in (SOLO, *FULL)
        }
        sys.stdout.write(f"{grid}x{grid}, {tasks} tasks, {routing}\n")
        for model, by_scheduler in spans_s.items():
            shown = "  ".join(f"{name} {span_s:10.3f}" for name, span_s in by_scheduler.items())
            turned = ", ".join(inversions(spans_s[SOLO], by_scheduler)) if model in FULL else ""
            sys.stdout.write(f"  {model:13s} {shown}  {turned}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
