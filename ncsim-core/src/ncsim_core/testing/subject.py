"""The component under test: which it is, and how to build it on any network."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import cast

from ncsim_core.contracts.link_model import LinkModel
from ncsim_core.models import ComponentIdentity
from ncsim_core.network import Network
from ncsim_core.plugins import Component
from ncsim_core.registry import RegisteredComponent, Registry
from ncsim_core.registry.option_schemas import with_defaults
from ncsim_core.testing.builders import make_context, rated
from ncsim_core.testing.questions import ASK, Answer, Case


@dataclass(frozen=True)
class Subject:
    """A registered component with the options of one example.

    Args:
        registry: Where it is registered.
        registered: The component.
        options: Options to build it with.
        sections: Config sections to build it with.
    """

    registry: Registry
    registered: RegisteredComponent
    options: Mapping[str, object] = field(default_factory=dict)
    sections: Mapping[str, Mapping[str, object]] = field(default_factory=dict)

    @property
    def component(self) -> Component:
        """Return the declaration."""
        return self.registered.component

    @property
    def identity(self) -> ComponentIdentity:
        """Return how errors name the component."""
        who = self.registered
        return ComponentIdentity(
            self.component.kind, who.qualified_name, who.distribution, who.version
        )

    def capability(self, name: str) -> str | None:
        """Return what follows ``name=`` among its capabilities, empty for a bare ``name``."""
        for each in sorted(self.component.capabilities):
            key, _, value = each.partition("=")
            if key == name:
                return value
        return None

    def settle(self, case: Case) -> Case:
        """Return the case with the network as this kind of component gets to see it.

        Link models see it without rates; the others see those of the radio link model if
        the component needs a radio, and otherwise those written in the network.
        """
        network = Network(case.network.nodes, case.network.links)
        if self.component.kind == "link_model":
            return case.with_network(network)
        radio = self._radio_link_model() if self.capability("needs_radio") is not None else None
        if radio is None:
            return case.with_network(rated(network))
        context = make_context(network, sections=self.sections)
        model, _ = self.registry.build("link_model", radio, {}, context)
        return case.with_network(network.with_rates(cast("LinkModel", model).rate_links(network)))

    def build(self, case: Case, seed: int = 42) -> object:
        """Return the component, built anew for a settled case."""
        context = make_context(
            case.network, seed=seed, sections=self.sections, injections=case.injections
        )
        name = self.registered.qualified_name
        return self.registry.build(self.component.kind, name, self.options, context)[0]

    def ask(self, component: object, case: Case) -> Answer:
        """Return its answer to a settled case."""
        return ASK[self.component.kind](component, case)

    def _radio_link_model(self) -> str | None:
        """Return a link model with a radio, of the same distribution if there is one."""
        radios = [
            each
            for each in self.registry.components("link_model")
            if "radio" in each.component.capabilities and each.is_available
        ]
        radios.sort(key=lambda each: each.distribution != self.registered.distribution)
        return radios[0].qualified_name if radios else None


def default_sections(registry: Registry) -> dict[str, Mapping[str, object]]:
    """Return all installed config sections with their defaults."""
    return {each.section.name: with_defaults(each.schema, {}) for each in registry.sections()}
