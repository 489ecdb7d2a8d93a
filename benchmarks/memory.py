"""Does memory grow in a line with the events of a run?

    python benchmarks/memory.py

Runs of 30,000 to a million events, each in a process of its own with its trace streamed to a file;
the peaks, the straight line that fits them best, and how far the farthest peak is from it.
"""

import re
import statistics
import subprocess
import sys
from pathlib import Path

EVENTS = (30_000, 100_000, 300_000, 1_000_000)
PEAK = re.compile(r"peak\s+(\d+) MB built,\s+(\d+) MB run")


def peaks_MB(events: int) -> tuple[int, int]:
    """Return the peak with the scenario built, and after the run with a trace."""
    command = [sys.executable, str(Path(__file__).with_name("engine.py")), "long_run", str(events)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    found = PEAK.search(done.stdout)
    assert found is not None, done.stdout
    return int(found[1]), int(found[2])


def main() -> None:
    """Measure, and fit a line."""
    runs_MB = []
    for events in EVENTS:
        built_MB, run_MB = peaks_MB(events)
        runs_MB.append(float(run_MB))
        print(f"{events:8} events: peak {built_MB:4} MB built, {run_MB:4} MB run", flush=True)
    slope, intercept = statistics.linear_regression(EVENTS, runs_MB)
    off = [abs(run - intercept - slope * n) / run for n, run in zip(EVENTS, runs_MB, strict=True)]
    print(
        f"a line: {intercept:.0f} MB and {slope * 1e5:.1f} MB per 100,000 events; "
        f"the farthest peak is {100 * max(off):.0f} % off"
    )


if __name__ == "__main__":
    main()
