"""Runs one workload in the published ncsim (anrg-ncsim 1.0.0); started with that venv's Python.

    python published.py WORKLOAD.yaml ROUTES.json [none|csma_bianchi]

``WORKLOAD.yaml`` has every task pinned, ``ROUTES.json`` the links between any two nodes. Prints the
CPU seconds of the run and the simulated seconds.
"""

import json
import logging
import sys
import time
from argparse import Namespace
from pathlib import Path

from ncsim.core.simulation import Simulation
from ncsim.io.scenario_loader import load_scenario
from ncsim.main import _setup_wifi_model
from ncsim.models.dag import MultiDAGSource
from ncsim.models.routing import RoutingModel
from ncsim.scheduler.base import ManualScheduler

CHOICES = ("tx_power", "freq", "path_loss_exponent", "wifi_standard", "rts_cts")
"""Options of the tool's command line that its radio set-up reads."""


class GivenRoutes(RoutingModel):
    """Routes worked out beforehand."""

    def __init__(self, path: str) -> None:
        rows = json.loads(Path(path).read_text(encoding="utf-8"))
        self._links = {(source, target): links for source, target, links in rows}

    def get_path(
        self, src_node: str, dst_node: str, *_network: object, **_state: object
    ) -> list[str]:
        """Return the ids of the links between two nodes."""
        return [] if src_node == dst_node else list(self._links[src_node, dst_node])


def main() -> None:
    """Run and print."""
    logging.disable(logging.CRITICAL)
    workload, routes, model = sys.argv[1:4]
    scenario = load_scenario(workload)
    interference = None
    if model != "none":
        options = Namespace(interference=model, **dict.fromkeys(CHOICES))
        interference, _ = _setup_wifi_model(scenario, options, 42, logging.getLogger())
    simulation = Simulation(
        scenario.network,
        ManualScheduler(),
        MultiDAGSource(scenario.dags),
        routing_model=GivenRoutes(routes),
        interference_model=interference,
    )
    started_s = time.process_time()
    result = simulation.run()
    print(f"{time.process_time() - started_s:.4f} s, {result.makespan} s simulated")


if __name__ == "__main__":
    main()
