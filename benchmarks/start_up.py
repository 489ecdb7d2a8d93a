"""What it costs to start: CPU time of whole commands, over that of a bare interpreter.

    python benchmarks/start_up.py [bare|help|run|radio|numpy]

``run``: three tasks under HEFT; ``radio``: ``examples/grid_4x4.yaml``. Medians of 5 child processes
each, user and system time as the kernel counts it, bytecode cached as in any installation.
"""

import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

REPEATS = 5
BIN = Path(sys.executable).parent
ROOT = Path(__file__).parents[1]
SMALL = """
scenario:
  network:
    nodes:
      - {id: a, compute_capacity: 50}
      - {id: b, compute_capacity: 100}
      - {id: c, compute_capacity: 400}
    links:
      - {id: ab, from: a, to: b, bandwidth: 5}
      - {id: ba, from: b, to: a, bandwidth: 5}
      - {id: bc, from: b, to: c, bandwidth: 5}
      - {id: cb, from: c, to: b, bandwidth: 5}
  dags:
    - id: d
      tasks:
        - {id: T0, compute_cost: 100}
        - {id: T1, compute_cost: 200}
        - {id: T2, compute_cost: 200}
      edges: [{from: T0, to: T1, data_size: 4}, {from: T0, to: T2, data_size: 4}]
  config: {scheduler: heft, routing: minimum_hop}
"""


def cpu_s(*command: str) -> float:
    """Return the median CPU time (s) of a command."""
    environment = {key: os.environ[key] for key in os.environ if key != "PYTHONDONTWRITEBYTECODE"}
    spent = []
    for _ in range(REPEATS + 1):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, cwd=ROOT, env=environment)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return statistics.median(spent[1:])  # the first writes bytecode


def main() -> None:
    """Measure what is asked for, or all."""
    python, ncsim = sys.executable, str(BIN / "ncsim")
    with tempfile.TemporaryDirectory() as folder:
        small = Path(folder) / "small.yaml"
        small.write_text(SMALL, encoding="utf-8")
        commands = {
            "bare": [python, "-c", "pass"],
            "help": [ncsim, "--help"],
            "run": [ncsim, "run", str(small)],
            "radio": [ncsim, "run", "examples/grid_4x4.yaml"],
            "numpy": [python, "-c", "import numpy"],
        }
        bare_s = cpu_s(*commands["bare"])
        for name in sys.argv[1:] or commands:
            spent_s = cpu_s(*commands[name])
            print(f"{name} {spent_s:.3f} s, {spent_s - bare_s:.3f} s over a bare interpreter")


if __name__ == "__main__":
    main()
