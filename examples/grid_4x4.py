"""Writes ``grid_4x4.yaml``: the paper's 4x4 grid and 20-task DAG, HEFT over minimum-hop routes."""

from pathlib import Path

from ncsim_core.generators.paper import paper_dag, paper_grid
from ncsim_core.scenario.making import make_scenario

CONFIG = {
    "seed": 42,
    "scheduler": "heft",
    "routing": "minimum_hop",
    "link_model": {"type": "wifi", "options": {"rate": "solo"}},
    "interference": "csma_bianchi",
}


def main() -> None:
    """Write the file beside this one."""
    scenario = make_scenario("4x4 grid, 20 tasks", paper_grid(4), [paper_dag(20)], CONFIG)
    head = (
        "# yaml-language-server: $schema=../schemas/scenario.schema.json\n"
        "# Made by grid_4x4.py. Full radio model; --interference none makes it Solo.\n"
    )
    Path(__file__).with_suffix(".yaml").write_text(head + scenario.to_yaml(), encoding="utf-8")


if __name__ == "__main__":
    main()
