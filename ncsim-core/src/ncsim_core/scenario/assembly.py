"""Builds what a scenario names: first the clean rates of the network, then the models.

Clean rates are decided here, once, before any snapshot or route.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from ncsim_core.context import BuildContext, ModelCache
from ncsim_core.contracts.link_model import LinkModel
from ncsim_core.contracts.routing_model import RouteTable, RoutingModel
from ncsim_core.errors import NcsimError, PluginError, told
from ncsim_core.models import ComponentIdentity, Models
from ncsim_core.network import LinkRates, Network
from ncsim_core.registry import Registry, get_registry
from ncsim_core.scenario.model import Scenario
from ncsim_core.units import MAX_QUANTITY, is_quantity

PURE: Final = "pure"
"""Capability of a routing model whose routes runs may share, whatever their seeds and sections."""

ROUTE_TABLES: Final = ModelCache(max_entries=8)
"""Routes by network and model. Few, for those of a large network are many; the runs of a sweep
that share a network follow one another."""


@dataclass(frozen=True)
class Assembly:
    """Everything a run is made of.

    Args:
        network: The scenario's network, its clean rates decided.
        models: The six components.
    """

    network: Network
    models: Models


def assemble(scenario: Scenario, registry: Registry | None = None) -> Assembly:
    """Return the rated network of a scenario and the models that decide on it.

    Raises:
        PluginError: A component does not build, or its link rates are not numbers of 0 or more.
        ScenarioError: A component refuses the scenario.
    """
    registry = registry or get_registry()
    link_model, identity = _build("link_model", scenario, scenario.network, registry)
    network = _rated(scenario, link_model, identity)
    others = {
        kind: _build(kind, scenario, network, registry)
        for kind in ("scheduler", "routing_model", "interference_model", "dag_source")
    }
    queue = scenario.config.components["queue_model"]
    context = _context(scenario, network)
    new_queue: Any
    new_queue, queue_identity = registry.builder("queue_model", queue.name, queue.options, context)
    identities = {kind: who for kind, (_, who) in others.items()}
    models = Models(
        scheduler=others["scheduler"][0],
        routing=others["routing_model"][0],
        link_model=link_model,
        interference=others["interference_model"][0],
        new_queue=new_queue,
        dag_source=others["dag_source"][0],
        identities={**identities, "link_model": identity, "queue_model": queue_identity},
        routes=_shared_routes(scenario, network, *others["routing_model"], registry),
    )
    return Assembly(network, models)


def link_rates_fault(rates: object, link_count: int) -> str | None:
    """Return why an answer cannot be the rates of ``link_count`` links, or ``None``."""
    if not isinstance(rates, LinkRates):
        return f"it gave {rates!r}, not LinkRates"
    for name in ("bandwidth_MBps", "latency_s"):
        values = getattr(rates, name)
        if len(values) != link_count:
            return f"{name} has {len(values)} values for {link_count} links"
        for index, value in enumerate(values):
            if not is_quantity(value):
                bounds = f"it must be from 0 to {MAX_QUANTITY:g}"
                return f"{name} of link index {index} is {value!r}; {bounds}"
    return None


def _rated(scenario: Scenario, link_model: LinkModel, identity: ComponentIdentity) -> Network:
    network = scenario.network
    try:
        rates = link_model.rate_links(network)
        fault = link_rates_fault(rates, len(network.links))
    except NcsimError:
        raise
    except (Exception, SystemExit) as error:  # a plug-in may do anything
        raise PluginError(f"{identity} raised {told(error)}") from error
    if fault is not None:
        raise PluginError(f"{identity}: rate_links(): {fault}")
    return network.with_rates(rates)


def _shared_routes(
    scenario: Scenario,
    network: Network,
    model: RoutingModel,
    identity: ComponentIdentity,
    registry: Registry,
) -> RouteTable | None:
    """Return the routes of this network that runs of this process have in common.

    ``None`` unless the model says that it neither draws nor remembers. The key is all that the
    answers of a pure model follow from: nodes, links and their rates, who it is, its options.
    """
    if PURE not in registry.find("routing_model", identity.name).component.capabilities:
        return None
    who = (identity.distribution, identity.version, identity.name)
    options = json.dumps(identity.options, sort_keys=True)
    return ROUTE_TABLES.get_or_build(
        (scenario.network.topology, network.rates, who, options),
        lambda: RouteTable(model, network, str(identity)),
    )


def _build(
    kind: str, scenario: Scenario, network: Network, registry: Registry
) -> tuple[Any, ComponentIdentity]:
    spec = scenario.config.components[kind]
    return registry.build(kind, spec.name, spec.options, _context(scenario, network))


def _context(scenario: Scenario, network: Network) -> BuildContext:
    sections: Mapping[str, Mapping[str, object]] = scenario.config.sections
    return BuildContext(
        network=network,
        seed=scenario.config.seed,
        sections=sections,
        injections=scenario.injections,
    )
