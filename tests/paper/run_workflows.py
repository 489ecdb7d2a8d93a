"""Runs the paper's workflow studies and prints one JSON line per run; started by the tests."""

import json
import sys
from pathlib import Path

from ncsim_core import simulate
from ncsim_core.generators.paper import paper_dag, paper_grid
from ncsim_core.scenario.making import make_scenario

REFERENCE = Path(__file__).parent / "data" / "workflows.json"


def rows():
    """Return the reference rows: 108 of the grid study, then 42 of the payload study."""
    reference = json.loads(REFERENCE.read_text(encoding="utf-8"))
    return reference["grid"] + reference["payload"]


def scenario_of(row):
    """Return the scenario of a reference row."""
    config = {
        "scheduler": row["scheduler"],
        "routing": row["routing"],
        "link_model": "wifi",
        "interference": "csma_bianchi" if row["mode"] == "full" else "none",
    }
    dag = paper_dag(row["tasks"], payload_MB=row.get("payload_MB", 10.0))
    return make_scenario("study", paper_grid(row["grid"]), [dag], config)


def main():
    for row in rows():
        result = simulate(scenario_of(row))
        answer = {
            "status": str(result.status),
            "makespan_s": result.makespan_s,
            "remote_MB": result.remote_MB,
            "route_work_MB_hops": result.route_work_MB_hops,
            "placement": {task: node for (_, task), node in result.placement.items()},
        }
        sys.stdout.write(json.dumps(answer) + "\n")


if __name__ == "__main__":
    main()
