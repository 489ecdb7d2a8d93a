"""What the sweep layer costs: 10,000 runs of the 3x3 grid with 5 tasks on two workers.

Processor time per run of the bare simulation and of the same run in a sweep, taken in turns; then
rate, processor time and memory of the whole sweep, stopped half-way, resumed, and asked for again.

Run: .venv/bin/python benchmarks/sweep.py [RUNS]
"""

import multiprocessing
import resource
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

from ncsim_core.engine.simulation import Simulation
from ncsim_core.scenario.assembly import assemble
from ncsim_core.sweep.reading import load_sweep
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.sweep.running import run_sweep

BATCH = 200
TURNS = 9


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


def bare_ms() -> float:
    """Return the processor time of one assembled and simulated run, without any sweep around it."""
    small = load_sweep(plan(BATCH))
    resolver = Resolver(small)
    scenarios = [resolver.scenario(run) for run in small.runs()]
    started_s = time.process_time()
    for scenario in scenarios:
        assembly = assemble(scenario)
        Simulation(assembly.network, assembly.models).run()
    return 1000 * (time.process_time() - started_s) / BATCH


def swept_ms() -> float:
    """Return the processor time of one run in a sweep, in this process, result stored."""
    with (
        tempfile.TemporaryDirectory() as folder,
        run_sweep(plan(BATCH), folder, executor="serial") as results,
    ):
        started_s = time.process_time()
        for _ in results:
            pass
        return 1000 * (time.process_time() - started_s) / BATCH


def compare_costs() -> None:
    """Print both costs, medians of batches taken in turns."""
    bare_ms()  # imports, caches
    swept_ms()
    turns = [(bare_ms(), swept_ms()) for _ in range(TURNS)]
    costs = [(alone, swept, swept - alone) for alone, swept in turns]
    alone, swept, more = (median(column) for column in zip(*costs, strict=True))
    print(f"processor time per run: bare {alone:.2f} ms, in a sweep {swept:.2f} ms")
    print(f"the sweep adds {more:.2f} ms per run (medians of {TURNS} turns of {BATCH} runs)")


def carry_out(what: str, runs: int, study: Path, stop_after: int | None = None) -> float:
    """Carry out the sweep, or a part of it, print what it took and return the seconds."""
    started_s, own_s, theirs_s = time.perf_counter(), time.process_time(), children_s()
    early_MB = 0.0
    done = 0
    with run_sweep(plan(runs), study, workers=2) as results:
        for done, _ in enumerate(results, start=1):
            if done == runs // 10:
                early_MB = memory_MB(resource.RUSAGE_SELF)
            if done == stop_after:
                break
    while multiprocessing.active_children():  # their processor time is known once they have left
        time.sleep(0.05)
    spent_s = time.perf_counter() - started_s
    own_s, theirs_s = time.process_time() - own_s, children_s() - theirs_s
    print(f"{what}: up to run {done} after {spent_s:.1f} s on the clock, {done / spent_s:.0f}/s")
    print(f"  processor time {own_s:.1f} s here and {theirs_s:.1f} s in the workers")
    late_MB = memory_MB(resource.RUSAGE_SELF)
    print(f"  memory here {early_MB:.0f} MB after a tenth, {late_MB:.0f} MB at the end")
    return spent_s


def children_s() -> float:
    """Return the processor time of all processes that have left."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def memory_MB(who: int) -> float:
    """Return the most memory that this process, or one that it started, has had."""
    return resource.getrusage(who).ru_maxrss / 1024


def main() -> None:
    """Measure and print."""
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    compare_costs()
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "study"
        whole_s = carry_out("first half", runs, study, stop_after=runs // 2)
        whole_s += carry_out("resumed", runs, study)
        carry_out("asked for again", runs, study)
        size_MB = (study / "results.sqlite").stat().st_size / 1e6
    print(f"{runs} runs in {whole_s:.1f} s on the clock, stopped and resumed once")
    print(f"largest worker {memory_MB(resource.RUSAGE_CHILDREN):.0f} MB, study {size_MB:.1f} MB")


if __name__ == "__main__":
    main()
