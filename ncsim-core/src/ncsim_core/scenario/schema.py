"""The JSON Schema of a scenario, composed of core's own part and what the plug-ins declare.

Draft-07 keywords only, for the sake of editors. ``anyOf`` of a bare name and a mapping lets an
editor complete both; ``if``/``then`` per component gives one error per fault at its exact place.
"""

from collections.abc import Mapping
from typing import Any, TypeAlias

from ncsim_core.plugins import KINDS, Kind
from ncsim_core.registry import RegisteredComponent, Registry
from ncsim_core.scenario.model import DEFAULT_SEED
from ncsim_core.units import MAX_QUANTITY

Schema: TypeAlias = dict[str, Any]

MAX_INJECT_AT_s = 9_000_000_000
"""285 years: beyond, microseconds are no longer exact in the double of a JSON reader."""

ID_PATTERN = r"^[^\x00-\x1f\x7f]+(?![\x00-\x1f])$"
QUALIFIED_NAME = r"^[a-z0-9][a-z0-9._-]*/[a-z][a-z0-9_]*$"


def compose_schema(registry: Registry) -> Schema:
    """Return the schema of a scenario file as the plug-ins of ``registry`` extend it."""
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "ncsim scenario",
        "description": "A network, the DAGs that run on it, and the models that decide.",
        **_object(
            {
                "$schema": _text("Address of this schema, for editors of JSON files."),
                "scenario": _scenario(registry),
            },
            required=["scenario"],
        ),
        "definitions": {"id": _ID},
    }


def _object(properties: Schema, required: list[str] | None = None) -> Schema:
    schema: Schema = {"type": "object", "properties": properties}
    if required:
        schema["required"] = required
    return {**schema, "additionalProperties": False}


def _list(items: Schema, description: str, **bounds: object) -> Schema:
    return {"type": "array", "description": description, "items": items, **bounds}


def _text(description: str, **bounds: object) -> Schema:
    return {"type": "string", "description": description, **bounds}


def _number(description: str, **bounds: object) -> Schema:
    return {"type": "number", "description": description, **bounds}


_ID: Schema = {
    "type": "string",
    "description": "A name of at least one character. Ids compare as text: n10 comes before n2.",
    "pattern": ID_PATTERN,
}


def _id(description: str) -> Schema:
    return {"description": description, "allOf": [{"$ref": "#/definitions/id"}]}


def _scenario(registry: Registry) -> Schema:
    properties = {
        "name": _text("What people call it; by default the name of the file."),
        "description": _text("Free text."),
        "network": _network(),
        "dags": _list(_dag(), "Workflows and when they enter.", minItems=1),
        "config": _config(registry),
    }
    return {
        "description": "Everything that a run is determined by.",
        **_object(properties, required=["network", "dags"]),
    }


def _network() -> Schema:
    properties = {
        "nodes": _list(_node(), "Places where tasks run, one at a time.", minItems=1),
        "links": _list(_link(), "Directed hops between nodes.", default=[]),
    }
    return {"description": "Nodes and links.", **_object(properties, required=["nodes"])}


def _node() -> Schema:
    position = _object({"x": _number("East, m."), "y": _number("North, m.")}, required=["x", "y"])
    properties = {
        "id": _id("Unique name of the node."),
        "compute_capacity": _number(
            "Compute units per second, above 0.", exclusiveMinimum=0, maximum=MAX_QUANTITY
        ),
        "position": {"description": "Where the node's radio is, m.", **position},
    }
    return _object(properties, required=["id", "compute_capacity"])


def _link() -> Schema:
    properties = {
        "id": _id("Unique name of the link."),
        "from": _id("Id of the sending node."),
        "to": _id("Id of the receiving node."),
        "bandwidth": _number(
            "Clean bandwidth, MB/s. A link model that derives rates from positions can do without.",
            minimum=0,
            maximum=MAX_QUANTITY,
        ),
        "latency": _number(
            "Paid once per transfer and hop, s.", minimum=0, maximum=MAX_QUANTITY, default=0.0
        ),
        "medium": {
            "description": "wired takes the link out of every radio model.",
            "enum": ["wireless", "wired"],
            "default": "wireless",
        },
    }
    return _object(properties, required=["id", "from", "to"])


def _dag() -> Schema:
    properties = {
        "id": _id("Unique name of the DAG."),
        "inject_at": _number(
            "When the DAG enters the run, s.", minimum=0, maximum=MAX_INJECT_AT_s, default=0.0
        ),
        "tasks": _list(_task(), "Pieces of work.", minItems=1),
        "edges": _list(_edge(), "Data that tasks hand on.", default=[]),
    }
    return _object(properties, required=["id", "tasks"])


def _task() -> Schema:
    properties = {
        "id": _id("Name of the task, unique within its DAG."),
        "compute_cost": _number("Compute units.", minimum=0, maximum=MAX_QUANTITY),
        "pinned_to": _id("Id of the node that must run it; without, the scheduler chooses."),
    }
    return _object(properties, required=["id", "compute_cost"])


def _edge() -> Schema:
    properties = {
        "from": _id("Id of the task that produces the data."),
        "to": _id("Id of the task that waits for it."),
        "data_size": _number("Payload, MB.", minimum=0, maximum=MAX_QUANTITY),
    }
    return _object(properties, required=["from", "to", "data_size"])


def _config(registry: Registry) -> Schema:
    properties: Schema = {
        "seed": {
            "type": "integer",
            "description": "Seed of all random draws of a run.",
            "minimum": 0,
            "default": DEFAULT_SEED,
        }
    }
    for kind in KINDS.values():
        properties[kind.config_key] = _component(kind, registry)
    for each in registry.sections():
        properties[each.section.name] = {"description": each.section.summary, **each.schema}
    return {"description": "The models that decide, and their seed.", **_object(properties)}


def _component(kind: Kind, registry: Registry) -> Schema:
    """Return the schema of a bare name, or of ``{type: name, options: {...}}``."""
    components = registry.components(kind.name)
    names = list(registry.names(kind.name))
    detailed: Schema = _object(
        {
            "type": {
                "description": "Name of the component.",
                "anyOf": [{"enum": names}, {"type": "string", "pattern": QUALIFIED_NAME}],
            },
            "options": {"type": "object", "description": "Options of that component."},
        },
        required=["type"],
    )
    detailed["allOf"] = [_options_of(each, names) for each in components]
    return {
        "description": f"{kind.question[0].upper()}{kind.question[1:]} {_catalogue(components)}",
        "anyOf": [{"enum": names}, {"type": "string", "pattern": QUALIFIED_NAME}, detailed],
    }


def _options_of(each: RegisteredComponent, names: list[str]) -> Schema:
    spellings = [
        name for name in (each.component.name, each.qualified_name) if "/" in name or name in names
    ]
    options: Mapping[str, object] = {"description": each.component.summary, **each.schema}
    then: Schema = {"properties": {"options": options}}
    if each.schema.get("required"):
        then["required"] = ["options"]
    return {
        "if": {"properties": {"type": {"enum": spellings}}, "required": ["type"]},
        "then": then,
    }


def _catalogue(components: tuple[RegisteredComponent, ...]) -> str:
    lines = (f"{each.component.name}: {each.component.summary}" for each in components)
    return " ".join(lines)
