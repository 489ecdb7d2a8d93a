"""``ncsim new``: a small scenario to start from."""

from pathlib import Path
from typing import Annotated, Final

import typer

from ncsim_core.errors import ScenarioError

STARTER: Final = """\
scenario:
  name: {name}
  network:
    nodes:                                    # compute_capacity in units/s
      - {{id: sensor, compute_capacity: 50}}
      - {{id: relay, compute_capacity: 100}}
      - {{id: server, compute_capacity: 400}}
    links:                                    # directed; bandwidth in MB/s, latency in s
      - {{id: sensor_relay, from: sensor, to: relay, bandwidth: 5, latency: 0.001}}
      - {{id: relay_server, from: relay, to: server, bandwidth: 5, latency: 0.001}}
  dags:
    - id: pipeline
      inject_at: 0                            # s
      tasks:                                  # compute_cost in units
        - {{id: capture, compute_cost: 10, pinned_to: sensor}}
        - {{id: filter, compute_cost: 200, pinned_to: relay}}
        - {{id: classify, compute_cost: 800, pinned_to: server}}
      edges:                                  # data_size in MB
        - {{from: capture, to: filter, data_size: 20}}
        - {{from: filter, to: classify, data_size: 4}}
  config:
    scheduler: manual                         # ncsim plugins list shows what is installed
    routing: direct
    interference: none
    seed: 42
"""


def new(
    path: Annotated[Path, typer.Argument(help="File to write, e.g. scenario.yaml.")],
) -> None:
    """Write a small commented scenario that runs as it is.

    Example: ncsim new first.yaml && ncsim run first.yaml
    """
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(STARTER.format(name=path.stem))
    except FileExistsError:
        raise ScenarioError(f"{path}: exists already; choose another name") from None
    typer.echo(f"{path} written; try: ncsim run {path}")
