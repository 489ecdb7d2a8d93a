"""Does memory grow in a line with the events of a run?

    python benchmarks/memory.py [pure|compiled]

Runs of 30,000 to a million events, each in a process of its own with its trace streamed to a file;
the peaks, the straight line that fits them best, and how far the farthest peak is from it. numba
is loaded from the start or not at all, since it takes as much as 100,000 events.
"""

import os
import re
import statistics
import subprocess
import sys
from pathlib import Path

EVENTS = (30_000, 100_000, 300_000, 1_000_000)
PEAK = re.compile(r"peak\s+(\d+) MB built,\s+(\d+) MB run")
LONG_RUN = {
    "pure": "import engine; engine.long_run({})",
    "compiled": "import numba, engine; engine.long_run({})",
}


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


def main(form: str = "pure") -> None:
    """Measure, and fit a line."""
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


if __name__ == "__main__":
    main(*sys.argv[1:])
