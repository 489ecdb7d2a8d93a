"""What it costs to start: CPU time of whole commands, over that of a bare interpreter.

    python benchmarks/start_up.py

Medians of 5 child processes each, user and system time as the kernel counts it.
"""

import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from table import Row, print_table

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
    spent = []
    for _ in range(REPEATS):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, cwd=ROOT)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return statistics.median(spent)


def rows() -> list[Row]:
    """Return what the commands take."""
    python, ncsim = sys.executable, str(BIN / "ncsim")
    with tempfile.TemporaryDirectory() as folder:
        small = os.path.join(folder, "small.yaml")  # noqa: PTH118 - text for a command line
        Path(small).write_text(SMALL, encoding="utf-8")
        bare_s = cpu_s(python, "-c", "pass")
        return [
            Row("python -c pass", None, bare_s),
            Row("ncsim --help, over that", 0.100, cpu_s(ncsim, "--help") - bare_s),
            Row("ncsim run, 3 tasks, heft", 0.300, cpu_s(ncsim, "run", small)),
            Row("ncsim run grid_4x4, radio", None, cpu_s(ncsim, "run", "examples/grid_4x4.yaml")),
            Row("import numpy", None, cpu_s(python, "-c", "import numpy")),
        ]


if __name__ == "__main__":
    print_table(rows())
