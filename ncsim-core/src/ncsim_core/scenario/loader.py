"""Reads a scenario: text, translation, overrides, checks, and at last the frozen description.

Every fault is collected before any is raised. Positions are worked out only when there are faults.
"""

import gc
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ncsim_core.errors import PluginError
from ncsim_core.network import Link, LinkId, Network, Node, NodeId, Position
from ncsim_core.registry import Registry, get_registry
from ncsim_core.scenario.explain import CONFIG, schema_problems
from ncsim_core.scenario.faults import Data, Problem, shown
from ncsim_core.scenario.model import Config, Scenario
from ncsim_core.scenario.overrides import override_path, with_overrides
from ncsim_core.scenario.positions import Slip
from ncsim_core.scenario.published_form import translated, translated_config
from ncsim_core.scenario.resolution import Undecided, resolve_config, unused_sections
from ncsim_core.scenario.semantics import (
    config_problems,
    dag_problems,
    network_problems,
)
from ncsim_core.scenario.source import Origins, Source, located, read_document, read_source
from ncsim_core.units import us_from_s
from ncsim_core.workflow import DAG, DagId, Dependency, Injection, Task, TaskId


def load_scenario(
    path: str | os.PathLike[str],
    overrides: Mapping[str, object] | None = None,
    registry: Registry | None = None,
) -> Scenario:
    """Return the scenario in a YAML or JSON file.

    Args:
        path: The file; ``.json`` must be JSON, anything else may be YAML or JSON.
        overrides: Values under ``config`` by dotted path, such as ``{"scheduler": "cpop",
            "rf.tx_power_dBm": 18, "scheduler.options.priority_queue_size": 4}``.
        registry: What is installed; by default this process's registry.

    Raises:
        ScenarioFaults: The file or an override is wrong; it lists all faults.
    """
    file = Path(path)
    source = read_source(file)
    loading = _Loading(file.stem, overrides, registry)
    with _uncollected():
        document, slips = read_document(source)
        return _loaded(document, slips, source, loading)


def parse_scenario(
    document: Mapping[str, Any] | str,
    overrides: Mapping[str, object] | None = None,
    *,
    name: str = "scenario",
    registry: Registry | None = None,
) -> Scenario:
    """Return the scenario in a YAML or JSON text, or in plain data as ``to_document`` gives it.

    Args:
        document: Text or data; data is not changed.
        overrides: As for ``load_scenario``.
        name: What faults call the source, and the scenario's name if it gives none.
        registry: What is installed; by default this process's registry.

    Raises:
        ScenarioFaults: The scenario or an override is wrong; it lists all faults.
    """
    loading = _Loading(name, overrides, registry)
    with _uncollected():
        if isinstance(document, str):
            source = Source(name, document)
            data, slips = read_document(source)
            return _loaded(data, slips, source, loading)
        return _loaded(dict(document), [], Source(name), loading)


@contextmanager
def _uncollected() -> Iterator[None]:
    """Keep the garbage collector from walking all that has been read again and again.

    Rows are no garbage, and there are hundreds of thousands in a large file: a third of its time.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


A_SWEEP = "is a sweep, not a scenario; ncsim sweep takes it"


class _Loading:
    """What a reading is asked for besides the document itself."""

    def __init__(
        self, name: str, overrides: Mapping[str, object] | None, registry: Registry | None
    ) -> None:
        self.name = name
        self.overrides = dict(overrides or {})
        self.registry = registry or get_registry()


def _loaded(document: Data, slips: list[Slip], source: Source, loading: _Loading) -> Scenario:
    translation = translated(document, loading.registry)
    overridden = with_overrides(translation.document, loading.overrides, loading.registry)
    translation = translated_config(translation, overridden, loading.registry)
    document = translation.document
    origins = Origins(
        moved=translation.moved,
        overrides={
            override_path(dotted): f"{dotted}={shown(value)}"
            for dotted, value in loading.overrides.items()
        },
    )
    problems = [*translation.problems, *_shape_problems(document, loading.registry)]
    config = _config(document, problems, loading.registry)
    if problems or slips or config is None:
        raise located(problems, slips, source, origins)
    rows = document["scenario"]
    unused = unused_sections(rows.get("config", {}), config, loading.registry)
    notes = (*translation.notes, *unused, *_missing_links(rows))
    return _built(rows, config, loading.name, notes)


def _missing_links(rows: Mapping[str, Any]) -> list[str]:
    """Return a note if data of a DAG could have to travel and there is no link at all."""
    network = rows["network"]
    has_edges = any(dag.get("edges") for dag in rows["dags"])
    if len(network["nodes"]) < 2 or network.get("links") or not has_edges:  # noqa: PLR2004
        return []
    return ["there are no links; ncsim new OUT --link FILE --range M makes them from positions"]


def _shape_problems(document: Data, registry: Registry) -> list[Problem]:
    if "sweep" in document and "scenario" not in document:
        return [Problem(("sweep",), A_SWEEP, is_about_key=True)]
    return [
        *schema_problems(document, registry),
        *network_problems(document),
        *dag_problems(document),
    ]


def _config(document: Data, problems: list[Problem], registry: Registry) -> Config | None:
    """Return the resolved config, adding to ``problems`` what goes wrong on the way."""
    scenario = document.get("scenario")
    is_readable = isinstance(scenario, dict) and isinstance(scenario.get("config", {}), dict)
    if not is_readable or any(each.path[:2] == CONFIG for each in problems):
        return None
    dags = scenario.get("dags")
    dag_count = len(dags) if isinstance(dags, list) else 1
    try:
        config = resolve_config(scenario.get("config", {}), dag_count, registry)
    except Undecided as undecided:
        problems.append(undecided.problem)
        return None
    except PluginError as error:
        problems.append(Problem(CONFIG, str(error)))
        return None
    problems += config_problems(document, config, registry)
    return config


def _built(
    rows: Mapping[str, Any], config: Config, default_name: str, notes: tuple[str, ...]
) -> Scenario:
    return Scenario(
        name=rows.get("name", default_name),
        description=rows.get("description", ""),
        network=network_from_rows(rows["network"]),
        injections=tuple(map(injection_from_row, rows["dags"])),
        config=config,
        notes=notes,
    )


def network_from_rows(rows: Mapping[str, Any]) -> Network:
    """Return the network in the checked rows of a file."""
    return Network(
        nodes=tuple(map(_node, rows["nodes"])),
        links=tuple(map(_link, rows.get("links", ()))),
    )


def _node(row: Mapping[str, Any]) -> Node:
    at = row.get("position")
    position = None if at is None else Position(float(at["x"]), float(at["y"]))
    return Node(NodeId(row["id"]), float(row["compute_capacity"]), position)


def _link(row: Mapping[str, Any]) -> Link:
    bandwidth = row.get("bandwidth")
    return Link(
        id=LinkId(row["id"]),
        source=NodeId(row["from"]),
        target=NodeId(row["to"]),
        bandwidth_MBps=None if bandwidth is None else float(bandwidth),
        latency_s=float(row.get("latency", 0.0)),
        medium=row.get("medium", "wireless"),
    )


def injection_from_row(row: Mapping[str, Any]) -> Injection:
    """Return the DAG and its time in a checked row of a file."""
    dag = DAG(
        id=DagId(row["id"]),
        tasks=tuple(map(_task, row["tasks"])),
        dependencies=tuple(
            Dependency(TaskId(edge["from"]), TaskId(edge["to"]), float(edge["data_size"]))
            for edge in row.get("edges", ())
        ),
    )
    return Injection(us_from_s(float(row.get("inject_at", 0.0))), dag)


def _task(row: Mapping[str, Any]) -> Task:
    pin = row.get("pinned_to")
    return Task(TaskId(row["id"]), float(row["compute_cost"]), None if pin is None else NodeId(pin))
