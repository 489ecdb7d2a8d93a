"""``ncsim new``: a small scenario to start from."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from ncsim_core.errors import ScenarioError

if TYPE_CHECKING:
    from ncsim_core.scenario.faults import Fault
    from ncsim_core.scenario.model import Scenario

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


NETWORK: Final = {"type": "paper_grid", "size": 3}
DAGS: Final = {"type": "paper", "tasks": 5}
BANDWIDTH_MBps: Final = 5.0
"""Of generated links where no installed plug-in derives it from positions."""


def new(
    path: Annotated[Path, typer.Argument(help="File to write; .json makes it JSON.")],
    network: Annotated[
        str | None, typer.Option(metavar="GENERATOR", help="Make a network, e.g. grid or line.")
    ] = None,
    dags: Annotated[
        str | None,
        typer.Option(metavar="GENERATOR", help="Make a DAG, e.g. fft or layered_random."),
    ] = None,
    link: Annotated[
        Path | None,
        typer.Option(metavar="SCENARIO", help="Link the nodes of this scenario; needs --range."),
    ] = None,
    range_m: Annotated[
        float | None,
        typer.Option("--range", min=0, metavar="M", help="Longest link of --link (m)."),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            "-s",
            metavar="KEY=VALUE",
            help="network.KEY or dags.KEY for the generator, else a key under config.",
        ),
    ] = None,
) -> None:
    """Write a small commented scenario that runs as it is, or one made by generators.

    Example: ncsim new big.yaml --network grid -s network.rows=4 -s network.columns=5
    --dags fft -s dags.points=8

    Example: ncsim new linked.yaml --link nodes.yaml --range 60
    """
    from ncsim_core.trace.files import json_text, write_atomically

    if path.exists():
        raise ScenarioError(f"{path}: exists already; choose another name")
    is_json = path.suffix.lower() == ".json"
    if link or network or dags or settings:
        made = (
            _linked(link, range_m, settings)
            if link
            else _generated(path.stem, network, dags, settings)
        )
        text = json_text(made.to_document()) if is_json else made.to_yaml()
    else:
        text = STARTER.format(name=path.stem)
        if is_json:
            from ncsim_core.scenario.loader import parse_scenario

            text = json_text(parse_scenario(text).to_document())
    write_atomically(path, text)
    typer.echo(f"{path} written; try: ncsim run {path}")


def _linked(path: Path, range_m: float | None, settings: Sequence[str] | None) -> "Scenario":
    """Return a scenario with links between all nodes in range of each other."""
    from ncsim_core.cli.choices import overrides_of
    from ncsim_core.generators.networks import linked
    from ncsim_core.scenario.loader import load_scenario

    if range_m is None:
        raise ScenarioError("--link needs --range M, the length of the longest link")
    scenario = load_scenario(path, overrides=overrides_of(settings))
    try:
        return replace(scenario, network=linked(scenario.network, range_m))
    except ScenarioError as error:
        raise ScenarioError(f"{path}: {error}") from error


def _generated(
    name: str, network: str | None, dags: str | None, settings: Sequence[str] | None
) -> "Scenario":
    """Return the scenario that generators make, by the rules of a sweep's base."""
    from ncsim_core.cli.choices import overrides_of
    from ncsim_core.scenario.faults import ScenarioFaults
    from ncsim_core.sweep.reading import load_sweep
    from ncsim_core.sweep.resolving import Resolver

    given = overrides_of(settings)
    base = {
        "network": _part("network", network, NETWORK, given),
        "dags": _part("dags", dags, DAGS, given),
        "config": _config(given),
    }
    _give_bandwidths(base)
    try:
        plan = load_sweep({"sweep": {"base": base}})
    except ScenarioFaults as error:
        raise ScenarioFaults([_told_here(fault) for fault in error.faults]) from None
    return replace(Resolver(plan).scenario(next(iter(plan.runs()))), name=name)


def _told_here(fault: "Fault") -> "Fault":
    return replace(fault, origin="ncsim new", path=fault.path.removeprefix("sweep.base."))


def _part(
    part: str, generator: str | None, default: Mapping[str, object], given: Mapping[str, object]
) -> dict[str, object]:
    """Return what a generator is asked for."""
    own = {
        key.removeprefix(f"{part}."): value
        for key, value in given.items()
        if key.startswith(f"{part}.")
    }
    start = dict(default) if generator in (None, default["type"]) else {"type": generator}
    return start | own


def _config(given: Mapping[str, object]) -> dict[str, object]:
    """Return the settings under ``config``, nested as a file would have them."""
    config: dict[str, Any] = {}
    for key, value in given.items():
        *outer, last = key.split(".")
        if outer[:1] not in (["network"], ["dags"]):
            inner = config
            for step in outer:
                inner = inner.setdefault(step, {})
            inner[last] = value
    return config


def _give_bandwidths(base: dict[str, dict[str, object]]) -> None:
    """Let the radio decide the links' rates if there is one, and route over several hops."""
    from ncsim_core.registry import get_registry

    registry, config = get_registry(), base["config"]
    if "minimum_hop" in registry.spellings("routing_model"):
        config.setdefault("routing", "minimum_hop")
    has_bandwidth = "bandwidth_MBps" in base["network"]
    if "csma_bianchi" in registry.spellings("interference_model") and not has_bandwidth:
        config.setdefault("interference", "csma_bianchi")
        config.setdefault("link_model", "wifi")
    base["network"].setdefault("bandwidth_MBps", None if "link_model" in config else BANDWIDTH_MBps)
