"""From the parameters in a file to networks and DAGs."""

import math
from collections.abc import Mapping
from typing import Any, Final

from ncsim_core.errors import ScenarioError
from ncsim_core.generators import dags as forms
from ncsim_core.generators import networks as shapes
from ncsim_core.generators.amounts import Amount, Uniform
from ncsim_core.generators.catalogue import (
    DAG_PROPERTIES,
    DAGS,
    NETWORK_PROPERTIES,
    NETWORKS,
    Generator,
    Parameters,
    Schema,
)
from ncsim_core.generators.streams import Draws
from ncsim_core.network import Network
from ncsim_core.units import us_from_s
from ncsim_core.workflow import Injection

MAX_PARTS: Final = 1_000_000
"""Nodes and links, or tasks and edges, of one scenario that a generator makes."""


def network_from(parameters: Parameters, draws: Draws) -> Network:
    """Return the network that ``{type: ..., ...}`` describes.

    Raises:
        ScenarioError: The parameters cannot be met.
    """
    generator = NETWORKS[parameters["type"]]
    _refuse_giants(generator, parameters, 1)
    shape = generator.make(draws, _filled(parameters, generator.properties), 0)
    own = _filled(parameters, NETWORK_PROPERTIES)
    equipment = shapes.Equipment(
        _amount(own["capacities"]), own["bandwidth_MBps"], float(own["latency_s"])
    )
    return shapes.network_of(shape, equipment, draws)


def dags_from(parameters: Parameters, draws: Draws) -> tuple[Injection, ...]:
    """Return the DAGs that ``{type: ..., ...}`` describes, with their times.

    Raises:
        ScenarioError: The parameters cannot be met.
    """
    generator = DAGS[parameters["type"]]
    own = _filled(parameters, DAG_PROPERTIES)
    _refuse_giants(generator, parameters, own["count"])
    workload = forms.Workload(_amount(own["compute_cost"]), _amount(own["payload_MB"]))
    given = _filled(parameters, generator.properties)
    return tuple(
        Injection(
            us_from_s(number * own["inject_every_s"]),
            forms.dag_of(generator.make(draws, given, number), workload, draws, number=number),
        )
        for number in range(own["count"])
    )


def _refuse_giants(generator: Generator, parameters: Parameters, count: int) -> None:
    """Raise if what is asked for would fill the memory before anybody could stop it."""
    try:
        size: float = count * generator.size(_filled(parameters, generator.properties))
    except OverflowError:  # 1e308 is a whole number, too
        size = math.inf
    if size > MAX_PARTS:
        raise ScenarioError(
            f"{generator.name} of this size has more than {MAX_PARTS:,} parts, the most allowed"
        )


def depends_on_seed(parameters: Parameters, generators: Mapping[str, Generator]) -> bool:
    """Return whether two seeds can make different things of the same parameters."""
    is_random = generators[parameters["type"]].is_random
    return is_random or any(isinstance(value, Mapping) for value in parameters.values())


def _filled(parameters: Parameters, properties: Mapping[str, Schema]) -> dict[str, Any]:
    """Return the parameters among ``properties``, defaults written out."""
    return {
        name: parameters.get(name, schema.get("default")) for name, schema in properties.items()
    }


def _amount(value: Any) -> Amount:  # noqa: ANN401 - plain data from a file
    if isinstance(value, Mapping):
        return Uniform(float(value["low"]), float(value["high"]))
    return tuple(value) if isinstance(value, list | tuple) else float(value)
