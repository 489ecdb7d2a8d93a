"""What a peer takes for one workload, in CPU seconds.

python benchmarks/peers/run.py simgrid|published SIZE TASKS [none|csma_bianchi] [REPEATS]
"""

import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))

from workloads import layered_scenario, write_for_peers  # noqa: E402 - found by the line above

PEERS = HERE.parents[1] / "out" / "peers"
SECONDS = re.compile(r"([\d.e-]+) s")


def command_of(peer: str, files: dict[str, Path], model: str) -> list[str]:
    """Return what runs a peer on a workload."""
    if peer == "simgrid":
        return [str(PEERS / "simgrid_lv08"), str(files["text"])]
    python, driver = PEERS / "venv" / "bin" / "python", HERE / "published.py"
    return [str(python), str(driver), str(files["yaml"]), str(files["routes"]), model]


def main() -> None:
    """Measure and print."""
    peer, size, tasks, *more = sys.argv[1:]
    model = more[0] if more else "none"
    repeats = int(more[1]) if more[1:] else 5
    with tempfile.TemporaryDirectory() as folder:
        scenario = layered_scenario(int(size), int(tasks), model)
        command = command_of(peer, write_for_peers(scenario, Path(folder)), model)
        spent = []
        for _ in range(repeats):
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            found = SECONDS.search(done.stdout)
            spent.append(float(found[1]) if found else float("nan"))
    shown = f"{peer} {size}x{size} {tasks} tasks {statistics.median(spent):.4f} s"
    print(f"{shown}; {done.stdout.strip()}")


if __name__ == "__main__":
    main()
