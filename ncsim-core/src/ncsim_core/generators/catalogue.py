"""Every generator by name, with the parameters that a sweep file may give and vary.

Parameters are plain data, checked against ``Generator.properties`` (JSON Schema, draft-07) before
they come here.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

from ncsim_core.generators import dags as forms
from ncsim_core.generators import networks as shapes
from ncsim_core.generators.paper import CAPACITIES, COMPUTE_COST, PAYLOAD_MB, SPACING_m
from ncsim_core.generators.streams import Draws
from ncsim_core.units import MAX_QUANTITY

Parameters: TypeAlias = Mapping[str, Any]
Schema: TypeAlias = Mapping[str, Any]


@dataclass(frozen=True)
class Generator:
    """A rule that makes networks or DAGs.

    Args:
        name: Under ``type`` in a sweep file.
        summary: One line.
        make: From draws, parameters and the number of the DAG (0 for networks), a shape or form.
        properties: JSON Schema of each parameter of its own.
        size: From the parameters, about how many nodes and links, or tasks and edges, that makes.
        is_random: Whether it draws even if all amounts are given.
    """

    name: str
    summary: str
    make: Callable[[Draws, Parameters, int], Any]
    properties: Mapping[str, Schema]
    size: Callable[[Parameters], int]
    is_random: bool = False

    @property
    def required(self) -> list[str]:
        """Return the parameters without a default."""
        return [name for name, schema in self.properties.items() if "default" not in schema]


PAIRS_PER_PART: Final = 25
"""Pairs of nodes whose distance is looked at in the time that one node or link takes to make."""


def _whole(description: str, minimum: int, **more: object) -> Schema:
    return {"type": "integer", "description": description, "minimum": minimum, **more}


def _positive(description: str, **more: object) -> Schema:
    return {"type": "number", "description": description, "exclusiveMinimum": 0, **more}


def _amounts(description: str, default: object, **bounds: object) -> Schema:
    number = {"type": "number", "maximum": MAX_QUANTITY, **bounds}
    drawn = {
        "type": "object",
        "properties": {
            "low": {"description": "Least value.", **number},
            "high": {"description": "Greatest value.", **number},
        },
        "required": ["low", "high"],
        "additionalProperties": False,
    }
    listed = {"type": "array", "items": number, "minItems": 1}
    by_form = {
        "if": {"type": "array"},
        "then": listed,
        "else": {"if": {"type": "object"}, "then": drawn, "else": number},
    }
    return {"description": description, **by_form, "default": default}


NETWORK_PROPERTIES: Final[Mapping[str, Schema]] = {
    "capacities": _amounts(
        "Compute units per second: one number, a list that is cycled, or {low, high} to draw from.",
        list(CAPACITIES),
        exclusiveMinimum=0,
    ),
    "bandwidth_MBps": {
        "description": "Clean bandwidth of every link, MB/s; without, the link model derives it.",
        "type": ["number", "null"],
        "minimum": 0,
        "maximum": MAX_QUANTITY,
        "default": None,
    },
    "latency_s": {
        "description": "Latency of every link, s.",
        "type": "number",
        "minimum": 0,
        "maximum": MAX_QUANTITY,
        "default": 0.0,
    },
}
"""What every network generator understands."""

DAG_PROPERTIES: Final[Mapping[str, Schema]] = {
    "compute_cost": _amounts(
        "Compute units per task: one number, a list that is cycled, or {low, high} to draw from.",
        COMPUTE_COST,
        minimum=0,
    ),
    "payload_MB": _amounts(
        "MB per edge: one number, a list that is cycled, or {low, high} to draw from.",
        PAYLOAD_MB,
        minimum=0,
    ),
    "count": _whole("DAGs of this form.", 1, default=1),
    "inject_every_s": {
        "description": "Time from one DAG to the next, s.",
        "type": "number",
        "minimum": 0,
        "default": 0.0,
    },
}
"""What every DAG generator understands."""

_SPACING = _positive("Distance of neighbours, m.", default=SPACING_m)
_SIDE = _positive("Side of the square, m.")
_RANGE = _positive("Longest link, m.")
_CONNECTED: Schema = {
    "type": "boolean",
    "description": "Draw again until every node can reach every other.",
    "default": True,
}

NETWORKS: Final[Mapping[str, Generator]] = {
    each.name: each
    for each in (
        Generator(
            "grid",
            "Rows and columns of nodes; by default the paper's mesh.",
            lambda _, given, __: shapes.grid(**given),
            {
                "rows": _whole("Rows.", 1),
                "columns": _whole("Columns.", 1),
                "spacing_m": _SPACING,
                "diagonals": {
                    "description": "Both in every other square (the paper's), in all, or in none.",
                    "enum": ["checkerboard", "all", "none"],
                    "default": "checkerboard",
                },
            },
            lambda given: 7 * given["rows"] * given["columns"],
        ),
        Generator(
            "paper_grid",
            "The paper's square grid (Section VII).",
            lambda _, given, __: shapes.grid(given["size"], given["size"]),
            {"size": _whole("Rows, and columns.", 1)},
            lambda given: 7 * given["size"] ** 2,
        ),
        Generator(
            "line",
            "Nodes in a row.",
            lambda _, given, __: shapes.line(**given),
            {"nodes": _whole("Nodes.", 1), "spacing_m": _SPACING},
            lambda given: 3 * given["nodes"],
        ),
        Generator(
            "ring",
            "Nodes on a circle.",
            lambda _, given, __: shapes.ring(**given),
            {"nodes": _whole("Nodes.", 3), "spacing_m": _SPACING},
            lambda given: 3 * given["nodes"],
        ),
        Generator(
            "star",
            "A node in the middle, linked to all others.",
            lambda _, given, __: shapes.star(**given),
            {
                "leaves": _whole("Nodes around the middle.", 1),
                "radius_m": _positive("Distance from the middle, m.", default=SPACING_m),
            },
            lambda given: 3 * given["leaves"],
        ),
        Generator(
            "random_geometric",
            "Nodes anywhere in a square, linked within range.",
            lambda draws, given, _: shapes.random_geometric(draws, **given),
            {
                "nodes": _whole("Nodes.", 1),
                "side_m": _SIDE,
                "range_m": _RANGE,
                "connected": _CONNECTED,
            },
            lambda given: given["nodes"] ** 2 // PAIRS_PER_PART,
            is_random=True,
        ),
        Generator(
            "clustered",
            "Nodes in clusters anywhere in a square, linked within range.",
            lambda draws, given, _: shapes.clustered(
                draws,
                shapes.Clusters(
                    given["clusters"], given["nodes_each"], given["side_m"], given["spread_m"]
                ),
                range_m=given["range_m"],
                connected=given["connected"],
            ),
            {
                "clusters": _whole("Clusters.", 1),
                "nodes_each": _whole("Nodes per cluster.", 1),
                "side_m": _SIDE,
                "spread_m": _positive("Standard deviation of a node around its centre, m."),
                "range_m": _RANGE,
                "connected": _CONNECTED,
            },
            lambda given: (given["clusters"] * given["nodes_each"]) ** 2 // PAIRS_PER_PART,
            is_random=True,
        ),
    )
}
"""Networks by rule."""

DAGS: Final[Mapping[str, Generator]] = {
    each.name: each
    for each in (
        Generator(
            "paper",
            "The paper's fork-join (5), diamond (10) or pipeline (20 tasks).",
            lambda _, given, __: forms.paper_form(**given),
            {"tasks": {"description": "5, 10 or 20.", "enum": [5, 10, 20]}},
            lambda given: 2 * given["tasks"],
        ),
        Generator(
            "chain",
            "Tasks one after the other.",
            lambda _, given, __: forms.chain(**given),
            {"tasks": _whole("Tasks.", 1)},
            lambda given: 2 * given["tasks"],
        ),
        Generator(
            "fork_join",
            "One task, several that it feeds, and one that they feed.",
            lambda _, given, __: forms.fork_join(**given),
            {"width": _whole("Tasks in the middle.", 1)},
            lambda given: 3 * given["width"],
        ),
        Generator(
            "diamond",
            "A square lattice of tasks, each feeding right and down; size 2 is four tasks.",
            lambda _, given, __: forms.diamond(**given),
            {"size": _whole("Tasks per side.", 1)},
            lambda given: 3 * given["size"] ** 2,
        ),
        Generator(
            "layered_random",
            "Layers of tasks, linked at random to the layer above.",
            lambda draws, given, number: forms.layered_random(draws, **given, number=number),
            {
                "layers": _whole("Layers.", 1),
                "width": _whole("Tasks per layer.", 1),
                "density": {
                    "description": "Probability of an edge beyond the one each task has.",
                    "type": "number",
                    "minimum": 0,
                    "maximum": 1,
                    "default": 0.3,
                },
            },
            lambda given: given["layers"] * given["width"] ** 2,
            is_random=True,
        ),
        Generator(
            "out_tree",
            "A tree that fans out.",
            lambda _, given, __: forms.out_tree(**given),
            {
                "depth": _whole("Levels below the root.", 0, maximum=20),
                "branching": _whole("Tasks fed by each.", 1, maximum=100),
            },
            lambda given: 2 * max(2, given["branching"]) ** (given["depth"] + 1),
        ),
        Generator(
            "gaussian_elimination",
            "Pivots and column updates of a square matrix.",
            lambda _, given, __: forms.gaussian_elimination(**given),
            {"size": _whole("Of the matrix.", 2)},
            lambda given: 2 * given["size"] ** 2,
        ),
        Generator(
            "fft",
            "Recursive calls and butterflies of a fast Fourier transform.",
            lambda _, given, __: forms.fft(**given),
            {"points": _whole("A power of 2.", 1)},
            lambda given: 4 * given["points"] * given["points"].bit_length(),
        ),
    )
}
"""DAGs by rule."""
