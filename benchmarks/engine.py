"""What the engine and the radio model cost.

    python benchmarks/engine.py [table|runs|scale|trace]

CPU seconds of a run, setup and routes included, loading and assembling not; medians of five. Every
line is measured in a process of its own, in Python or in the compiled loop.
"""

import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path

from ncsim_core.engine.observer import Watcher
from ncsim_core.engine.simulation import Simulation
from ncsim_core.generators.paper import paper_dag, paper_grid
from ncsim_core.scenario.assembly import Assembly, assemble
from ncsim_core.scenario.making import make_scenario
from ncsim_core.trace.writer import TraceWriter
from workloads import layered_dag, layered_scenario, wired_grid

REPEATS = 5
SIZES = ((5, 1_000), (10, 1_000), (20, 100), (20, 1_000), (20, 10_000))
TARGETS_s = {
    ("none", 5, 1_000): 0.020,
    ("none", 20, 1_000): 0.045,
    ("none", 20, 10_000): 0.9,
    ("pure", 5, 1_000): 0.2,
    ("fast", 5, 1_000): 0.06,
    ("pure", 20, 100): 0.05,
    ("fast", 20, 1_000): 0.5,
    ("fast", 20, 10_000): 10.0,
}
"""By form (``none`` or csma_bianchi ``pure`` and ``fast``), size of the grid and tasks."""

FORMS = ("none", "pure", "loop", "fast")
"""Without a radio and with one, in Python; the same two in the compiled loop."""
COMPILED = ("loop", "fast")

WIDTH = 32  # tasks per layer where length alone should count
EVENTS = (10_000, 100_000, 1_000_000)
EVENTS_PER_TASK = 6.7


def cpu_s(assembly: Assembly, observers: Callable[[], Iterable[Watcher]] = tuple) -> float:
    """Return the CPU time of one run."""
    began_s = time.process_time()
    Simulation(assembly.network, assembly.models, observers=observers()).run()
    return time.process_time() - began_s


def median_s(assembly: Assembly) -> float:
    """Return the median of several runs, after one that fills the caches of the process."""
    cpu_s(assembly)
    return statistics.median(cpu_s(assembly) for _ in range(REPEATS))


def one(form: str, size: int, tasks: int) -> None:
    """Print one line of the table."""
    interference = "none" if form in ("none", "loop") else "csma_bianchi"
    took_s = median_s(assemble(layered_scenario(size, tasks, interference)))
    target_s = TARGETS_s.get((form, size, tasks))
    judged = "" if target_s is None else f"   target {target_s:g} s"
    print(f"{form:5} {size:2}x{size:<2} {tasks:6} tasks {took_s:8.4f} s{judged}", flush=True)


def paper_runs() -> None:
    """Print what the 108 runs of the paper's grid study take, scheduling included."""
    scenarios = [
        make_scenario(
            f"{size} {tasks} {scheduler} {interference} {routing}",
            paper_grid(size),
            [paper_dag(tasks)],
            {"scheduler": scheduler, "interference": interference, "routing": routing,
             "link_model": "wifi"},
        )
        for size in (2, 3, 4)
        for tasks in (5, 10, 20)
        for scheduler in ("heft", "cpop", "round_robin")
        for interference in ("none", "csma_bianchi")
        for routing in ("minimum_hop", "widest_path")
    ]  # fmt: skip
    for when in ("first", "again"):
        began_s = time.process_time()
        for scenario in scenarios:
            cpu_s(assemble(scenario))
        print(f"{len(scenarios)} runs, {when}: {time.process_time() - began_s:.3f} s", flush=True)


def long_run(events: int, form: str = "none") -> None:
    """Print what a run of some length costs, its trace streamed to a file."""
    dag = layered_dag(round(events / EVENTS_PER_TASK), WIDTH)
    config = {"scheduler": "round_robin", "routing": "minimum_hop", "interference": "none"}
    assembly = assemble(make_scenario("long", wired_grid(5), [dag], config))
    if form in COMPILED:
        cpu_s(assembly)  # loads the loop
    built_MB = _peak_MB()
    plain_s = cpu_s(assembly)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "trace.jsonl"
        traced_s = cpu_s(assembly, lambda: [TraceWriter(path)])
        size_MB = path.stat().st_size / 1e6
    print(
        f"{form:5} {events:8} events {plain_s:7.2f} s, {1e6 * plain_s / events:5.1f} us each; "
        f"with trace {traced_s:6.2f} s: {100 * (1 - plain_s / traced_s):.0f} % of it, "
        f"{size_MB:6.1f} MB; peak {built_MB:4.0f} MB built, "
        f"{_peak_MB():4.0f} MB run",
        flush=True,
    )


def trace_share(size: int, tasks: int, interference: str) -> None:
    """Print which part of a run is writing its trace."""
    assembly = assemble(layered_scenario(size, tasks, interference))
    with tempfile.TemporaryDirectory() as folder:
        pairs = [
            (
                cpu_s(assembly),
                cpu_s(assembly, lambda k=k: [TraceWriter(Path(folder, f"{k}.jsonl"))]),
            )
            for k in range(REPEATS)
        ]
    plain_s, traced_s = (statistics.median(each) for each in zip(*pairs, strict=True))
    print(
        f"{interference:12} {size:2}x{size:<2} {tasks:6} tasks {plain_s:.4f} s, with full trace "
        f"{traced_s:.4f} s: {100 * (1 - plain_s / traced_s):.0f} % of it",
        flush=True,
    )


def _peak_MB() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def table() -> None:
    """Measure all sizes and forms."""
    for form in FORMS:
        for size, tasks in SIZES:
            _in_new_process("one", form, size, tasks, is_pure=form not in COMPILED)


def runs() -> None:
    """Measure the paper's runs."""
    _in_new_process("paper_runs", is_pure=True)


def scale() -> None:
    """Measure how cost grows with length."""
    for form in ("none", "loop"):
        for events in EVENTS:
            _in_new_process("long_run", events, form, is_pure=form not in COMPILED)


def trace() -> None:
    """Measure the trace's share."""
    for interference in ("none", "csma_bianchi"):
        for size in (5, 20):
            _in_new_process("trace_share", size, 1_000, interference, is_pure=True)


def _in_new_process(name: str, *arguments: object, is_pure: bool) -> None:
    environment = os.environ | {"NCSIM_PURE": "1" if is_pure else "0"}
    command = [sys.executable, __file__, name, *map(str, arguments)]
    subprocess.run(command, check=True, env=environment)


PARTS = {each.__name__: each for each in (table, runs, scale, trace)}
LINES: dict[str, Callable[..., None]] = {
    each.__name__: each for each in (one, paper_runs, long_run, trace_share)
}


def main() -> None:
    """Measure the parts asked for, or all; or, in a process started for it, one line."""
    name, *arguments = sys.argv[1:] or ["all"]
    if name in LINES:
        numbers = [int(each) if each.isdigit() else each for each in arguments]
        LINES[name](*numbers)
        return
    for part in [*PARTS] if name == "all" else [name, *arguments]:
        PARTS[part]()


if __name__ == "__main__":
    main()
