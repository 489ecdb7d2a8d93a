"""What a declaration module says, checked piece by piece before any of it is registered."""

import inspect
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from types import ModuleType

import pluggy

from ncsim_core.errors import PluginError
from ncsim_core.plugins import KINDS, NAME_PATTERN, PLUGIN_API, Component, Section
from ncsim_core.registry.option_schemas import read_schema
from ncsim_core.registry.records import (
    RegisteredComponent,
    RegisteredSection,
    requirement_form_fault,
)
from ncsim_core.registry.well_known import provider

RESERVED_SECTIONS = frozenset(kind.config_key for kind in KINDS.values()) | {"seed"}

_API_PATTERN = re.compile(r"(\d+)\.(\d+)")
_FACTORY_PATTERN = re.compile(r"[A-Za-z_][\w.]*:[A-Za-z_][\w.]*")


@dataclass(frozen=True)
class Owner:
    """Who declares: the distribution and its version."""

    distribution: str
    version: str


def api_fault(declared: object) -> str | None:
    """Return why a plug-in with this ``NCSIM_PLUGIN_API`` cannot run here, or ``None``.

    >>> api_fault("1.0") is None
    True
    >>> api_fault("2.0")
    'it is written for plug-in API 2.0; this ncsim-core offers 1.0'
    """
    if declared is None:
        return 'its declaration module sets no NCSIM_PLUGIN_API, such as "1.0"'
    match = _API_PATTERN.fullmatch(str(declared))
    if match is None:
        return f'NCSIM_PLUGIN_API is {declared!r}; write it as "1.0"'
    major, minor = int(match[1]), int(match[2])
    if major == PLUGIN_API[0] and minor <= PLUGIN_API[1]:
        return None
    offered = ".".join(map(str, PLUGIN_API))
    return f"it is written for plug-in API {declared}; this ncsim-core offers {offered}"


def refuse_unmarked_hooks(module: ModuleType) -> None:
    """Raise if the module defines a function that looks like a hook and is not marked as one.

    Raises:
        PluginError: It does.
    """
    for name, value in vars(module).items():
        is_own_function = inspect.isfunction(value) and value.__module__ == module.__name__
        if name.startswith("ncsim_") and is_own_function and not hasattr(value, "ncsim_impl"):
            raise PluginError(f"{name}() looks like a hook; decorate it with @hookimpl")


def declared_components(
    manager: pluggy.PluginManager, module: ModuleType, owner: Owner
) -> list[RegisteredComponent]:
    """Return the components that one module declares.

    Raises:
        PluginError: One of them is not well formed, or two share a kind and name.
    """
    registered: dict[tuple[str, str], RegisteredComponent] = {}
    for component in _answers(manager.hook.ncsim_components, module):
        if not isinstance(component, Component):
            raise PluginError(f"ncsim_components() gave {component!r}, not a Component")
        new = _checked_component(component, owner)
        key = (component.kind, component.name)
        if key in registered:
            raise PluginError(f"it declares {component.kind} {component.name!r} twice")
        registered[key] = new
    return list(registered.values())


def declared_sections(
    manager: pluggy.PluginManager, module: ModuleType, owner: Owner
) -> list[RegisteredSection]:
    """Return the config sections that one module declares.

    Raises:
        PluginError: One of them is not well formed, or its name belongs to somebody else.
    """
    sections: dict[str, RegisteredSection] = {}
    for section in _answers(manager.hook.ncsim_sections, module):
        if not isinstance(section, Section):
            raise PluginError(f"ncsim_sections() gave {section!r}, not a Section")
        if section.name in sections:
            raise PluginError(f"it declares section {section.name!r} twice")
        sections[section.name] = _checked_section(section, owner)
    return list(sections.values())


def _answers(hook: pluggy.HookCaller, module: ModuleType) -> Iterator[object]:
    """Yield what one module answers to a hook; the other plug-ins are not asked."""
    for implementation in hook.get_hookimpls():
        if implementation.plugin is module:
            answer = implementation.function()
            if not isinstance(answer, Iterable):
                raise PluginError(f"{hook.name}() gave {answer!r}, not a list")
            yield from answer


def _checked_component(component: Component, owner: Owner) -> RegisteredComponent:
    label = f"{component.kind} {component.name!r}"
    if component.kind not in KINDS:
        raise PluginError(f"{label}: unknown kind; the kinds are {', '.join(KINDS)}")
    _refuse_bad_name(component.name, label)
    if not _FACTORY_PATTERN.fullmatch(str(component.factory)):
        raise PluginError(
            f'{label}: factory is {component.factory!r}; write it as "package.module:callable"'
        )
    for text in component.requires:
        fault = requirement_form_fault(text)
        if fault is not None:
            raise PluginError(f"{label}: requires has {text!r}: {fault}")
    try:
        schema = read_schema(component.options)
    except PluginError as error:
        raise PluginError(f"{label}: {error}") from error
    return RegisteredComponent(component, owner.distribution, owner.version, schema)


def _checked_section(section: Section, owner: Owner) -> RegisteredSection:
    label = f"section {section.name!r}"
    _refuse_bad_name(section.name, label)
    if section.name in RESERVED_SECTIONS:
        raise PluginError(f"{label}: the name is a config key of ncsim itself")
    rightful = provider("section", section.name)
    if rightful not in (None, owner.distribution):
        raise PluginError(f"{label}: the name belongs to {rightful}")
    try:
        schema = read_schema(section.schema)
    except PluginError as error:
        raise PluginError(f"{label}: {error}") from error
    return RegisteredSection(section, owner.distribution, owner.version, schema)


def _refuse_bad_name(name: object, label: str) -> None:
    if not (isinstance(name, str) and NAME_PATTERN.match(name)):
        raise PluginError(f"{label}: names are lower-case letters, digits and _, such as my_model")
