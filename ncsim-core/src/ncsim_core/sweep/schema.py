"""The JSON Schema of a sweep file."""

from collections.abc import Mapping
from typing import Any, TypeAlias

from ncsim_core.generators.catalogue import (
    DAG_PROPERTIES,
    DAGS,
    NETWORK_PROPERTIES,
    NETWORKS,
    Generator,
)
from ncsim_core.registry import Registry
from ncsim_core.scenario.schema import compose_schema

Schema: TypeAlias = dict[str, Any]

_FILE = {"type": "string", "description": "A scenario file to take it from."}


def sweep_schema(registry: Registry) -> Schema:
    """Return the schema of a sweep file as the plug-ins of ``registry`` extend it."""
    scenario = compose_schema(registry)
    parts = scenario["properties"]["scenario"]["properties"]
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "ncsim sweep",
        "description": "Many runs that differ in what is varied.",
        **structure(parts["config"], parts["network"], parts["dags"]),
        "definitions": scenario["definitions"],
    }


def structure(
    config: Mapping[str, Any] | None = None,
    network: Mapping[str, Any] | None = None,
    dags: Mapping[str, Any] | None = None,
) -> Schema:
    """Return the schema of the frame; what is not given is left to a check of its own."""
    values = {
        "description": "Values by config path (rf.tx_power_dBm) or generator parameter "
        "(network.size); all combinations are run.",
        "type": "object",
        "additionalProperties": _levels(),
    }
    properties = {
        "name": {"type": "string", "description": "What people call it."},
        "description": {"type": "string", "description": "Free text."},
        "base": _base(config, network, dags),
        "vary": values,
        "zip": {
            "description": "Groups of paths whose lists are walked together.",
            "type": "array",
            "items": {**values, "description": "Lists of equal length, by path."},
        },
        "where": {
            "description": "Condition(s) on the varied values: network.size > 2 and ...",
            "type": ["string", "array"],
            "items": {"type": "string"},
        },
        "replicate": _replicate(),
        "limits": _limits(),
    }
    sweep = _object(properties, "A base and what is varied.", ["base"])
    pointer = {"type": "string", "description": "Where editors find this schema."}
    return {
        "type": "object",
        "properties": {"sweep": sweep, "$schema": pointer},
        "required": ["sweep"],
        "additionalProperties": False,
    }


def _base(
    config: Mapping[str, Any] | None,
    network: Mapping[str, Any] | None,
    dags: Mapping[str, Any] | None,
) -> Schema:
    anything: Schema = {"type": "object"}
    return _object(
        {
            "scenario": {**_FILE, "description": "Scenario file, relative to this one."},
            "network": _part("network", NETWORKS, NETWORK_PROPERTIES, network or anything),
            "dags": _part("dags", DAGS, DAG_PROPERTIES, dags or {"type": "array"}),
            "config": config or anything,
        },
        "What all runs have in common: a scenario file, and what is put in its place.",
    )


def generator_schema(
    generator: Generator, common: Mapping[str, Any], description: str = ""
) -> Schema:
    """Return the schema of ``{type: name, ...}`` of one generator."""
    name = {"type": "string", "description": "Name of the generator."}
    properties = {"type": name, **generator.properties, **common}
    return _object(properties, description or generator.summary, ["type", *generator.required])


def _part(
    noun: str,
    generators: Mapping[str, Generator],
    common: Mapping[str, Any],
    rows: Mapping[str, Any],
) -> Schema:
    branches = [
        {
            "if": {
                "type": "object",
                "properties": {"type": {"const": each.name}},
                "required": ["type"],
            },
            "then": generator_schema(each, common),
        }
        for each in generators.values()
    ]
    named = {
        "if": {"type": "object", "required": ["type"]},
        "then": {"properties": {"type": {"enum": list(generators)}}},
        "else": {
            "if": {"type": "object", "required": ["file"]},
            "then": _object({"file": _FILE}, ""),
            "else": dict(rows),
        },
    }
    return {
        "description": f"The {noun}: rows as in a scenario, a generator, or a file.",
        "allOf": [named, *branches],
    }


def _levels() -> Schema:
    number = {"type": "number"}
    span = _object(
        {
            "from": number,
            "to": number,
            "step": number,
            "count": {"type": "integer", "minimum": 1},
            "scale": {"enum": ["linear", "log"]},
        },
        "A range, ends included.",
        ["from", "to"],
    )
    return {
        "if": {"type": "object"},
        "then": span,
        "else": {"type": "array", "minItems": 1, "description": "The values, each once."},
    }


def _replicate() -> Schema:
    seeds = {
        "description": "How many (seeds 1 to n), or which.",
        "if": {"type": "array"},
        "then": {"items": {"type": "integer", "minimum": 0}, "minItems": 1},
        "else": {"type": "integer", "minimum": 1},
    }
    pair = {
        "description": "Paths along which runs are compared and share their draws; other "
        "combinations get draws of their own. Without it, all runs of a seed share them.",
        "type": "array",
        "items": {"type": "string"},
    }
    return _object({"seeds": seeds, "pair": pair}, "Random replications.")


def _limits() -> Schema:
    return _object(
        {
            "wall_s": {"type": "number", "exclusiveMinimum": 0, "description": "Clock time, s."},
            "max_events": {"type": "integer", "minimum": 0, "description": "Events."},
            "max_time_s": {"type": "number", "minimum": 0, "description": "Simulated time, s."},
            "memory_MB": {"type": "number", "exclusiveMinimum": 0, "description": "Memory, MB."},
        },
        "When to give up on one run.",
    )


def _object(properties: Schema, description: str, required: list[str] | None = None) -> Schema:
    schema: Schema = {"type": "object", "properties": properties, "additionalProperties": False}
    if description:
        schema["description"] = description
    return {**schema, "required": required} if required else schema
