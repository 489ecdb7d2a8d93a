"""The one workload that all benchmarks share: a layered DAG on a square grid.

Grid k x k as in the paper's study (``generators.paper``), N tasks in layers of about the square
root of N, every task below the first layer with one to three parents in the layer above; cost 500
units, payload 10 MB, ``round_robin``, minimum-hop routes. Drawn from the standard library's
generator, so that every Python makes the same one.

    python benchmarks/workloads.py 20 1000 scenario.json    # to look at, or for another tool
"""

import json
import math
import random
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from ncsim_core.api import simulate
from ncsim_core.contracts.routing_model import RoutingModel
from ncsim_core.engine.setup import Limits
from ncsim_core.generators.dags import Form, dag_of
from ncsim_core.generators.paper import paper_grid
from ncsim_core.network import Link, Network
from ncsim_core.scenario.assembly import assemble
from ncsim_core.scenario.making import make_scenario
from ncsim_core.scenario.model import Scenario
from ncsim_core.workflow import DAG

SEED = 42
MOST_PARENTS = 3
BANDWIDTH_MBps = 3.3
"""Of every link where no radio decides it; about what the paper's grid offers without traffic."""
OUTAGE_FLOOR = 0.01
"""Of csma_bianchi; without one, layered DAGs of 100 tasks and more end blocked."""


def layered_dag(tasks: int, width: int | None = None) -> DAG:
    """Return the layered DAG of this many tasks.

    Args:
        tasks: How many.
        width: Tasks per layer; by default the square root of ``tasks``, rounded.
    """
    width = width or max(1, round(math.sqrt(tasks)))
    draw = random.Random(SEED)
    edges = []
    for task in range(width, tasks):
        above = (task // width - 1) * width
        parents = draw.sample(range(width), min(width, draw.randint(1, MOST_PARENTS)))
        edges += [(f"T{above + parent}", f"T{task}") for parent in sorted(parents)]
    return dag_of(Form([f"T{number}" for number in range(tasks)], edges), dag_id="layered")


def wired_grid(size: int) -> Network:
    """Return the paper's grid with the same bandwidth on every link."""
    grid = paper_grid(size)
    links = (Link(each.id, each.source, each.target, BANDWIDTH_MBps) for each in grid.links)
    return Network(grid.nodes, tuple(links))


def layered_scenario(
    size: int, tasks: int, interference: str = "none", scheduler: str = "round_robin"
) -> Scenario:
    """Return the layered DAG on the ``size`` x ``size`` grid.

    Args:
        size: Nodes along a side.
        tasks: Of the DAG.
        interference: ``none`` on equal wired links, or a radio model on the paper's grid.
        scheduler: Who places the tasks.
    """
    network = wired_grid(size) if interference == "none" else paper_grid(size)
    config = {
        "scheduler": scheduler,
        "routing": "minimum_hop",
        "interference": _interference_row(interference),
    }
    return make_scenario(f"layered {size}x{size} {tasks}", network, [layered_dag(tasks)], config)


def _interference_row(name: str) -> object:
    if name != "csma_bianchi":
        return name
    return {"type": name, "options": {"outage_floor_factor": OUTAGE_FLOOR}}


def write_for_peers(scenario: Scenario, folder: Path) -> dict[str, Path]:
    """Write a workload of one DAG for other tools, with ncsim's placements and routes.

    Returns:
        ``text``: numbers for the SimGrid driver; ``yaml`` and ``routes``: for the published ncsim.
    """
    network, model = _rated(scenario)
    placement = simulate(scenario, limits=Limits(max_events=1)).placement
    dag = scenario.injections[0].dag
    node_of = {task.id: network.node_index[placement[dag.id, task.id]] for task in dag.tasks}
    pairs = {(node_of[each.source], node_of[each.target]) for each in dag.dependencies}
    routes = {(s, t): model.route(s, t, network) or () for s, t in sorted(pairs) if s != t}
    index = dag.task_index
    blocks = [
        [f"{node.compute_capacity}" for node in network.nodes],
        [f"{rate_MBps}" for rate_MBps in network.bandwidth_MBps],
        [f"{s} {t} {len(way)} {' '.join(map(str, way))}" for (s, t), way in routes.items()],
        [f"{task.compute_cost} {node_of[task.id]}" for task in dag.tasks],
        [f"{index[d.source]} {index[d.target]} {d.data_size_MB}" for d in dag.dependencies],
    ]
    names, links = network.nodes, network.links
    rows = [
        (names[s].id, names[t].id, [links[i].id for i in way]) for (s, t), way in routes.items()
    ]
    texts = {
        "text": "".join(f"{line}\n" for block in blocks for line in (len(block), *block)),
        "yaml": json.dumps(_pinned(scenario, placement)),
        "routes": json.dumps(rows),
    }
    files = {name: folder / f"workload.{name}" for name in texts}
    for name, path in files.items():
        path.write_text(texts[name], encoding="utf-8")
    return files


def _rated(scenario: Scenario) -> tuple[Network, RoutingModel]:
    assembly = assemble(scenario)
    return assembly.network, assembly.models.routing


def _pinned(scenario: Scenario, placement: Mapping[tuple[str, str], str]) -> dict[str, object]:
    """Return a scenario as the published ncsim reads it, every task on its node."""
    body = cast("dict[str, Any]", scenario.to_document()["scenario"])
    for link in body["network"]["links"]:
        del link["medium"]
    for dag in body["dags"]:
        for task in dag["tasks"]:
            task["pinned_to"] = placement[dag["id"], task["id"]]
    return {"scenario": {**body, "config": {"scheduler": "manual"}}}


def main() -> None:
    """Write a workload as a JSON scenario."""
    size, tasks, path = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    scenario = layered_scenario(size, tasks, *sys.argv[4:])
    path.write_text(json.dumps(scenario.to_document()), encoding="utf-8")


if __name__ == "__main__":
    main()
