"""What a run needs in memory as tasks, nodes and links grow; ``memory.py`` lets events grow.

    python benchmarks/memory_by_size.py             the table
    python benchmarks/memory_by_size.py one CASE    one line of it, in this process

Every case runs in a process of its own, its trace streamed to a file. *Input* is what the scenario
takes once it is made and assembled, *run* by how much resident memory rises above that while it is
simulated, routes and the tables of the engine included, *peak* all that the process ever had. Linux
only.
"""

import gc
import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Final, TypeAlias

from ncsim_core.engine.simulation import Simulation
from ncsim_core.generators.dags import Form, dag_of
from ncsim_core.network import Link, LinkId, Network, Node, NodeId
from ncsim_core.scenario.assembly import assemble
from ncsim_core.scenario.making import make_scenario
from ncsim_core.trace.writer import TraceWriter
from ncsim_core.workflow import DAG
from workloads import BANDWIDTH_MBps, layered_dag, wired_grid

STATUS: Final = Path("/proc/self/status")
CLEAR_PEAK: Final = Path("/proc/self/clear_refs")

Parts: TypeAlias = tuple[Callable[[], Network], Callable[[], DAG]]
"""What makes the network and the DAG of a case."""


def chain(tasks: int) -> DAG:
    """Return tasks of which each waits for the one before."""
    names = [f"T{number}" for number in range(tasks)]
    return dag_of(Form(names, list(pairwise(names))), dag_id="chain")


def ring(nodes: int) -> Network:
    """Return nodes in a ring, each with links to four others: some near, some far."""
    ends = [
        (number, (number + step) % nodes) for number in range(nodes) for step in (1, 7, 49, 343)
    ]
    return Network(
        tuple(Node(NodeId(f"n{number}"), 100.0) for number in range(nodes)),
        tuple(
            Link(LinkId(f"l{a}_{b}"), NodeId(f"n{a}"), NodeId(f"n{b}"), BANDWIDTH_MBps)
            for a, b in ends
        ),
    )


CASES: Final[dict[str, Parts]] = {
    "1,000 tasks, 400 nodes": (partial(wired_grid, 20), partial(layered_dag, 1_000)),
    "10,000 tasks, 400 nodes": (partial(wired_grid, 20), partial(layered_dag, 10_000)),
    "1,000 tasks, 500 nodes, 2,000 links": (partial(ring, 500), partial(layered_dag, 1_000)),
    "1,000 tasks, 2,000 nodes, 8,000 links": (partial(ring, 2_000), partial(layered_dag, 1_000)),
    "a chain of 50,000 tasks": (partial(wired_grid, 5), partial(chain, 50_000)),
}


def one(name: str) -> None:
    """Print one line of the table."""
    network, dag = (make() for make in CASES[name])
    config = {"scheduler": "round_robin", "routing": "minimum_hop", "interference": "none"}
    assembly = assemble(make_scenario(name, network, [dag], config))
    gc.collect()
    built_MB = resident_MB("VmRSS")
    most_MB = resident_MB("VmHWM")
    CLEAR_PEAK.write_text("5")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "trace.jsonl"
        outcome = Simulation(assembly.network, assembly.models, observers=[TraceWriter(path)]).run()
        trace_MB = path.stat().st_size / 1e6
    run_MB = resident_MB("VmHWM") - built_MB
    peak_MB = max(most_MB, built_MB + run_MB)
    each = 1e6 * run_MB / outcome.events
    numbers = f"{outcome.events:,} | {built_MB:.0f} | {run_MB:.1f} | {each:.0f}"
    print(f"| {name} | {numbers} | {peak_MB:.0f} | {trace_MB:.1f} |", flush=True)


def resident_MB(field: str) -> float:
    """Return the memory that this process has (``VmRSS``) or has had at most (``VmHWM``)."""
    line = next(each for each in STATUS.read_text().splitlines() if each.startswith(field))
    return int(line.split()[1]) * 1024 / 1e6


def main() -> None:
    """Measure one case, or all, each in a new process."""
    if sys.argv[1:2] == ["one"]:
        one(sys.argv[2])
        return
    print("| run | events | input MB | run MB | bytes per event | peak MB | trace MB |")
    print("|---|---:|---:|---:|---:|---:|---:|", flush=True)
    for name in CASES:
        subprocess.run([sys.executable, __file__, "one", name], check=True)


if __name__ == "__main__":
    main()
