"""10,000 runs of the 3x3, 5-task case: rate, overhead over the bare simulation, memory, resuming.

Run: .venv/bin/python benchmarks/sweep.py [RUNS]
"""

import resource
import sys
import tempfile
import time
from pathlib import Path

from ncsim_core.engine.simulation import Simulation
from ncsim_core.scenario.assembly import assemble
from ncsim_core.sweep.reading import load_sweep
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.sweep.running import run_sweep


def plan(runs: int) -> dict[str, object]:
    """Return the sweep: one scenario, as many seeds as runs."""
    return {
        "sweep": {
            "base": {
                "network": {"type": "paper_grid", "size": 3},
                "dags": {"type": "paper", "tasks": 5},
                "config": {"routing": "minimum_hop", "interference": "csma_bianchi"},
            },
            "replicate": {"seeds": runs},
        }
    }


def bare_ms(runs: int = 300) -> float:
    """Return the time of one assembled and simulated run, without any sweep around it."""
    small = load_sweep(plan(runs))
    resolver = Resolver(small)
    scenarios = [resolver.scenario(run) for run in small.runs()]
    started_s = time.process_time()
    for scenario in scenarios:
        assembly = assemble(scenario)
        Simulation(assembly.network, assembly.models).run()
    return 1000 * (time.process_time() - started_s) / runs


def main() -> None:
    """Measure and print."""
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    bare_ms(20)  # imports
    alone_ms = bare_ms()
    with run_sweep(plan(300), executor="serial") as results:
        started_s = time.process_time()
        results.table()
        serial_ms = 1000 * (time.process_time() - started_s) / 300
    print(f"bare {alone_ms:.2f} ms, in a sweep {serial_ms:.2f} ms of processor time per run")
    with tempfile.TemporaryDirectory() as folder:
        for what in ("run", "resumed"):
            started_s = time.perf_counter()
            with run_sweep(plan(runs), Path(folder) / "study", workers=2) as results:
                early_MB = 0.0
                for done, _ in enumerate(results, start=1):
                    if done == runs // 10:
                        early_MB = memory_MB()
            spent_s = time.perf_counter() - started_s
            print(f"{what}: {runs} runs in {spent_s:.1f} s, {runs / spent_s:.0f}/s")
            print(f"  memory {early_MB:.0f} MB after a tenth, {memory_MB():.0f} MB at the end")
    children_MB = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print(f"largest worker {children_MB:.0f} MB")


def memory_MB() -> float:
    """Return the most memory that this process has had."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


if __name__ == "__main__":
    main()
