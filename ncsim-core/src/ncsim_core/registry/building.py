"""From a declaration to an object: import, options, call, and what came back."""

import importlib
from collections.abc import Callable
from functools import cache
from typing import TypeAlias

from ncsim_core.context import BuildContext
from ncsim_core.errors import NcsimError, PluginError, ScenarioError, told
from ncsim_core.models import ComponentIdentity
from ncsim_core.plugins import KINDS
from ncsim_core.registry.messages import close_match
from ncsim_core.registry.option_schemas import properties_of
from ncsim_core.registry.records import RegisteredComponent

Factory: TypeAlias = Callable[..., object]


def load_object(location: str) -> object:
    """Return what ``"package.module:name.inside"`` points to."""
    module_name, _, path = location.partition(":")
    found: object = importlib.import_module(module_name)
    for name in path.split("."):
        found = getattr(found, name)
    return found


@cache
def contract_of(kind: str) -> type:
    """Return the abstract base class of a kind; asked for every queue of a network."""
    contract = load_object(KINDS[kind].contract)
    assert isinstance(contract, type)
    return contract


def checked_options(registered: RegisteredComponent, identity: ComponentIdentity) -> None:
    """Raise if an option is unknown or a required one is missing.

    Types and bounds are the scenario's business, where line numbers are known.

    Raises:
        ScenarioError: One is.
    """
    known = properties_of(registered.schema)
    for name in identity.options:
        if name not in known:
            meant = close_match(name, known)
            hint = f"did you mean {meant!r}? " if meant else ""
            options = ", ".join(known) or "none"
            raise ScenarioError(f"{identity}: unknown option {name!r}; {hint}options: {options}")
    required = registered.schema.get("required", ())
    for name in required if isinstance(required, list | tuple) else ():
        if name not in identity.options:
            raise ScenarioError(f"{identity}: option {name!r} is missing")


def imported(registered: RegisteredComponent, identity: ComponentIdentity) -> Factory:
    """Return a component's factory.

    Raises:
        PluginError: It cannot be imported or cannot be called.
    """
    location = registered.component.factory
    try:
        factory = load_object(location)
    except (Exception, SystemExit) as error:
        raise PluginError(f"{identity}: cannot import {location}: {told(error)}") from error
    if not callable(factory):
        raise PluginError(f"{identity}: {location} is {factory!r}, which cannot be called")
    return factory


def built(
    factory: Factory,
    registered: RegisteredComponent,
    identity: ComponentIdentity,
    context: BuildContext,
) -> object:
    """Return what a factory makes, checked against the contract of its kind.

    Raises:
        PluginError: The factory raised, or made something else. Errors of ncsim's own, such
            as ``ScenarioError``, pass as they are.
    """
    try:
        component = factory(context, **{**registered.component.params, **identity.options})
    except NcsimError:
        raise
    except (Exception, SystemExit) as error:
        raise PluginError(f"{identity}: building it failed: {told(error)}") from error
    contract = contract_of(identity.kind)
    if not isinstance(component, contract):
        raise PluginError(
            f"{identity}: {identity.factory} gave {type(component).__name__}, "
            f"which is no {contract.__name__}"
        )
    return component


def factory_fault(registered: RegisteredComponent) -> str | None:
    """Return why a component cannot be built, as far as importing its factory shows."""
    component = registered.component
    identity = ComponentIdentity(
        component.kind, component.name, registered.distribution, registered.version
    )
    try:
        factory = imported(registered, identity)
    except PluginError as error:
        return str(error)
    contract = contract_of(component.kind)
    if isinstance(factory, type) and not issubclass(factory, contract):
        return f"{identity}: {factory.__name__} is no {contract.__name__}"
    return None
