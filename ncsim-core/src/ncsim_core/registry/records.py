"""What the registry knows: plug-ins, and the components and sections they brought."""

import importlib.metadata
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, TypeAlias

from ncsim_core.plugins import Component, Section

PluginStatus: TypeAlias = Literal["ok", "disabled", "failed", "incompatible"]

OptionsSchema: TypeAlias = Mapping[str, object]
"""A JSON Schema (draft-07) of one object, within the portable subset."""

_PLAIN_REQUIREMENT = re.compile(
    r"[A-Za-z][A-Za-z0-9-]*[A-Za-z0-9](?:(?:[<>]=?|[!=]=)[0-9]+(?:\.[0-9]+)*)?"
)
"""Such as ``anrg-saga>=2.1``: certainly valid, so that packaging need not be imported to say so."""


@dataclass(frozen=True)
class PluginRecord:
    """One entry point and what became of it.

    Args:
        distribution: Normalised name of the package: the identity of a plug-in.
        version: Version of the package.
        api: ``NCSIM_PLUGIN_API`` as declared; empty if it was not read.
        status: Whether its components can be used.
        detail: Why not, for people.
    """

    distribution: str
    version: str
    api: str = ""
    status: PluginStatus = "ok"
    detail: str = ""

    @property
    def is_broken(self) -> bool:
        """Return whether it should have loaded and did not."""
        return self.status in ("failed", "incompatible")


@dataclass(frozen=True)
class RegisteredComponent:
    """A component and the package that answers for it.

    Args:
        component: What was declared.
        distribution: Normalised name of the package.
        version: Version of the package.
        schema: The options schema, read from its file if it was declared as one.
    """

    component: Component
    distribution: str
    version: str
    schema: OptionsSchema

    @property
    def qualified_name(self) -> str:
        """Return ``distribution/name``, which is valid in every scenario."""
        return f"{self.distribution}/{self.component.name}"

    @cached_property
    def missing_requirements(self) -> tuple[str, ...]:
        """Return what ``requires`` asks for in vain, such as ``anrg-saga>=2.1 (have 2.0.2)``."""
        faults = (requirement_fault(text) for text in self.component.requires)
        return tuple(fault for fault in faults if fault is not None)

    @property
    def is_available(self) -> bool:
        """Return whether all its requirements are met."""
        return not self.missing_requirements


@dataclass(frozen=True)
class RegisteredSection:
    """A config section and the package that owns it.

    Args:
        section: What was declared.
        distribution: Normalised name of the package.
        version: Version of the package.
        schema: The section's schema, read from its file if it was declared as one.
    """

    section: Section
    distribution: str
    version: str
    schema: OptionsSchema


def normalised(name: str) -> str:
    """Return a distribution's name as package tools compare it.

    >>> normalised("My_Plugin")
    'my-plugin'
    """
    return re.sub(r"[-_.]+", "-", name).lower()


def requirement_form_fault(text: str) -> str | None:
    """Return why a text is no requirement, or ``None``; plain ones cost no import."""
    if _PLAIN_REQUIREMENT.fullmatch(text):
        return None
    from packaging.requirements import InvalidRequirement, Requirement

    try:
        Requirement(text)
    except InvalidRequirement as error:
        return str(error)
    return None


def requirement_fault(text: str) -> str | None:
    """Return how a requirement such as ``anrg-saga>=2.1`` is unmet, from metadata alone."""
    from packaging.requirements import Requirement

    requirement = Requirement(text)
    if requirement.marker is not None and not requirement.marker.evaluate():
        return None
    wanted = f"{requirement.name}{requirement.specifier}"
    try:
        have = importlib.metadata.version(requirement.name)
    except importlib.metadata.PackageNotFoundError:
        return f"{wanted} (not installed)"
    if requirement.specifier.contains(have, prereleases=True):
        return None
    return f"{wanted} (have {have})"
