"""How much memory runs take: does it grow in a line with the events, and what do large ones need?

    python benchmarks/memory.py [pure|compiled|large [none|csma_bianchi]]

``pure`` and ``compiled``: runs of 30,000 to a million events, each in a process of its own with its
trace streamed to a file; the peaks, the straight line that fits them best, and how far the farthest
peak is from it. numba is loaded from the start or not at all, since it takes as much as 100,000
events. ``large``: 10,000 tasks on 2,000 nodes with some 8,000 links whose rates the radio decides.
"""

import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from ncsim_core.engine.simulation import Simulation
from ncsim_core.generators.networks import grid, network_of
from ncsim_core.scenario.assembly import assemble
from ncsim_core.scenario.making import make_scenario
from ncsim_core.trace.writer import TraceWriter
from workloads import OUTAGE_FLOOR, layered_dag

EVENTS = (30_000, 100_000, 300_000, 1_000_000)
PEAK = re.compile(r"peak\s+(\d+) MB built,\s+(\d+) MB run")
LONG_RUN = {
    "pure": "import engine; engine.long_run({})",
    "compiled": "import numba, engine; engine.long_run({})",
}
ROWS, COLUMNS, TASKS = 40, 50, 10_000


def peaks_MB(form: str, events: int) -> tuple[int, int]:
    """Return the peak with the scenario built, and after the run with a trace."""
    settings = {"PYTHONPATH": str(Path(__file__).parent), "NCSIM_PURE": str(int(form == "pure"))}
    command = [sys.executable, "-c", LONG_RUN[form].format(events)]
    done = subprocess.run(
        command, check=True, capture_output=True, text=True, env=os.environ | settings
    )
    found = PEAK.search(done.stdout)
    assert found is not None, done.stdout
    return int(found[1]), int(found[2])


def growth(form: str) -> None:
    """Measure runs of several lengths, and fit a line."""
    runs_MB = []
    for events in EVENTS:
        built_MB, run_MB = peaks_MB(form, events)
        runs_MB.append(float(run_MB))
        print(f"{events:8} events: peak {built_MB:4} MB built, {run_MB:4} MB run", flush=True)
    slope, intercept = statistics.linear_regression(EVENTS, runs_MB)
    off = [abs(run - intercept - slope * n) / run for n, run in zip(EVENTS, runs_MB, strict=True)]
    print(
        f"a line: {intercept:.0f} MB and {slope * 1e5:.1f} MB per 100,000 events; "
        f"the farthest peak is {100 * max(off):.0f} % off"
    )


def large(interference: str) -> None:
    """Print what one large run takes, its trace streamed to a file."""
    options = {"outage_floor_factor": OUTAGE_FLOOR} if interference == "csma_bianchi" else {}
    config = {
        "scheduler": "round_robin",
        "routing": "minimum_hop",
        "link_model": "wifi",
        "interference": {"type": interference, "options": options},
    }
    network = network_of(grid(ROWS, COLUMNS, diagonals="none"))
    began_s = time.process_time()
    assembly = assemble(make_scenario("large", network, [layered_dag(TASKS)], config))
    with tempfile.TemporaryDirectory() as folder:
        writer = TraceWriter(Path(folder) / "trace.jsonl")
        outcome = Simulation(assembly.network, assembly.models, observers=[writer]).run()
    print(
        f"{interference}: {len(network.nodes)} nodes, {len(network.links)} links, {TASKS} tasks: "
        f"{outcome.status}, {outcome.events} events, {time.process_time() - began_s:.1f} s, "
        f"peak {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB"
    )


if __name__ == "__main__":
    what, *more = sys.argv[1:] or ["pure"]
    large(*more or ["none"]) if what == "large" else growth(what)
