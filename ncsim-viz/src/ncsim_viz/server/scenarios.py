"""Scenarios for the form: checked, written and described by the code that the command line uses."""

import math
from collections.abc import Mapping
from itertools import islice
from pathlib import Path
from typing import Any, Final

from ncsim_core.errors import NcsimError
from ncsim_core.generators.catalogue import (
    DAG_PROPERTIES,
    DAGS,
    NETWORK_PROPERTIES,
    NETWORKS,
    Generator,
    Schema,
)
from ncsim_core.plugins import KINDS, Kind
from ncsim_core.registry import RegisteredComponent, Registry, get_registry
from ncsim_core.scenario.assembly import assemble
from ncsim_core.scenario.faults import ScenarioFaults
from ncsim_core.scenario.loader import parse_scenario
from ncsim_core.scenario.model import Scenario
from ncsim_core.scenario.source import Source, read_document
from ncsim_core.scenario.yaml_text import dump_yaml
from ncsim_core.sweep.axes import Run
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.sweep.store import Store

from ncsim_viz.server.errors import missing

NAME: Final = "scenario"

Document = dict[str, Any]


def checked(text: str) -> tuple[Scenario | None, list[Document]]:
    """Return the scenario in a text, its models built once, or all that is wrong with it."""
    try:
        scenario = parse_scenario(text, name=NAME)
        assemble(scenario)
    except ScenarioFaults as error:
        return None, [fault_row(each) for each in error.to_json()]
    except NcsimError as error:
        return None, [fault_row({"message": str(error)})]
    return scenario, []


def validation(text: str) -> Document:
    """Return what a scenario's text means and what is wrong with it, ready for JSON."""
    scenario, faults = checked(text)
    return {
        "valid": scenario is not None,
        "faults": faults,
        "document": _document(text),
        "resolved": None if scenario is None else scenario.to_document(),
        "summary": None if scenario is None else _summary(scenario),
        "notes": [] if scenario is None else list(scenario.notes),
    }


def fault_row(fault: Mapping[str, object]) -> Document:
    """Return a fault of ``ncsim validate --json`` with all that the page looks at."""
    row: Document = {"message": "", "pointer": "", "path": ""}
    row |= dict.fromkeys(("line", "column", "value", "suggestion"))
    return row | {key: value for key, value in fault.items() if key in row}


def _document(text: str) -> object:
    """Return the data in a text as JSON can hold it; ``None`` if it is no mapping."""
    try:
        document, _ = read_document(Source(NAME, text))
    except ScenarioFaults:
        return None
    return _json_ready(document)


def _json_ready(value: object) -> object:
    """Return plain data with infinite numbers as YAML writes them, which no schema accepts."""
    if isinstance(value, dict):
        return {str(key): _json_ready(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_json_ready(each) for each in value]
    if isinstance(value, float) and not math.isfinite(value):
        return dump_yaml(value).split("\n", maxsplit=1)[0]
    return value


def _summary(scenario: Scenario) -> dict[str, int]:
    return {
        "nodes": len(scenario.network.nodes),
        "links": len(scenario.network.links),
        "dags": len(scenario.injections),
        "tasks": task_count(scenario),
    }


def task_count(scenario: Scenario) -> int:
    """Return how many tasks a scenario asks for."""
    return sum(len(injection.dag.tasks) for injection in scenario.injections)


def study_scenario(folder: Path, number: int) -> str:
    """Return the scenario of one run of a study as YAML.

    Args:
        folder: Of the study.
        number: Which of its runs, in the order of its table, from 0.

    Raises:
        RequestError: It has no such run.
    """
    with Store(folder, must_exist=True) as store:
        plan, _ = store.current()
        row = next(islice(store.rows(), number, None), None)
    if row is None:
        raise missing(f"run {number}")
    values, seed, _ = row
    return Resolver(plan).scenario(Run(number, values, seed)).to_yaml()


def catalogue() -> Document:
    """Return every component, section and generator with the schema of its options."""
    from ncsim_core.cli.new import STARTER

    registry = get_registry()
    return {
        "kinds": [_kind(kind, registry) for kind in KINDS.values()],
        "sections": [
            {
                "name": each.section.name,
                "summary": each.section.summary,
                "distribution": each.distribution,
                "schema": each.schema,
            }
            for each in registry.sections()
        ],
        "generators": {
            "networks": [_generator(each, NETWORK_PROPERTIES) for each in NETWORKS.values()],
            "dags": [_generator(each, DAG_PROPERTIES) for each in DAGS.values()],
        },
        "broken": [
            {"distribution": each.distribution, "detail": each.detail}
            for each in registry.plugins
            if each.is_broken
        ],
        "starter": STARTER.format(name="first"),
    }


def _kind(kind: Kind, registry: Registry) -> Document:
    offers = zip(registry.names(kind.name), registry.components(kind.name), strict=True)
    return {
        "kind": kind.name,
        "config_key": kind.config_key,
        "question": kind.question,
        "components": [_component(name, each) for name, each in offers],
    }


def _component(name: str, each: RegisteredComponent) -> Document:
    return {
        "name": name,
        "summary": each.component.summary,
        "distribution": each.distribution,
        "version": each.version,
        "source": each.component.source,
        "options": each.schema,
        "missing": list(each.missing_requirements),
    }


def _generator(generator: Generator, common: Mapping[str, Schema]) -> Document:
    return {
        "type": generator.name,
        "summary": generator.summary,
        "is_random": generator.is_random,
        "parameters": {
            "type": "object",
            "properties": {**generator.properties, **common},
            "required": generator.required,
            "additionalProperties": False,
        },
    }
