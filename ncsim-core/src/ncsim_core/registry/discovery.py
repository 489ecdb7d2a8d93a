"""Finds plug-ins by entry point and loads each so that a broken one harms no other."""

import importlib.metadata
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from importlib.metadata import EntryPoint
from types import ModuleType

import pluggy

from ncsim_core.errors import NcsimError, PluginError
from ncsim_core.plugins import PLUGIN_GROUP, HookSpecs
from ncsim_core.registry.catalogue import Registry
from ncsim_core.registry.declarations import (
    Owner,
    api_fault,
    declared_components,
    declared_sections,
    refuse_unmarked_hooks,
)
from ncsim_core.registry.records import (
    PluginRecord,
    RegisteredComponent,
    RegisteredSection,
    normalised,
)

CORE = "ncsim-core"

ALLOW_VARIABLE = "NCSIM_PLUGINS"
DISABLE_VARIABLE = "NCSIM_DISABLE_PLUGINS"
STRICT_VARIABLE = "NCSIM_STRICT_PLUGINS"


class IncompatiblePluginError(PluginError):
    """A plug-in is written for another plug-in API."""


@dataclass(frozen=True)
class Selection:
    """Which plug-ins the environment lets in.

    Args:
        allowed: Distributions that may load; ``None`` allows all.
        disabled: Distributions that may not; ``*`` stands for all.
        is_strict: Whether a broken plug-in is an error at once.
    """

    allowed: frozenset[str] | None = None
    disabled: frozenset[str] = frozenset()
    is_strict: bool = False

    @classmethod
    def from_environment(cls, environment: Mapping[str, str]) -> "Selection":
        """Return what the ``NCSIM_*PLUGINS`` variables say; empty ones count as unset."""
        return cls(
            allowed=_names(environment.get(ALLOW_VARIABLE, "")) or None,
            disabled=_names(environment.get(DISABLE_VARIABLE, "")),
            is_strict=environment.get(STRICT_VARIABLE, "") not in ("", "0"),
        )

    def reason_against(self, distribution: str) -> str | None:
        """Return why a distribution may not load; ncsim-core always may."""
        if distribution == CORE:
            return None
        if self.disabled & {distribution, "*"}:
            return f"by {DISABLE_VARIABLE}"
        if self.allowed is not None and distribution not in self.allowed:
            return f"not in {ALLOW_VARIABLE}"
        return None


def load_registry(environment: Mapping[str, str] | None = None) -> Registry:
    """Return a registry of everything installed, ncsim-core first, then by distribution.

    Args:
        environment: Variables to obey instead of the process's own.

    Raises:
        PluginError: A plug-in is broken and ``NCSIM_STRICT_PLUGINS`` is set.
    """
    selection = Selection.from_environment(os.environ if environment is None else environment)
    loading = _Loading()
    for entry_point, record in _found_plugins():
        reason = selection.reason_against(record.distribution)
        if reason is not None:
            loading.records.append(replace(record, status="disabled", detail=reason))
            continue
        loading.load(entry_point, record)
        _raise_if_strict(selection, loading.records[-1])
    return Registry(loading.records, loading.components, loading.sections, loading.manager)


@dataclass
class _Loading:
    """What has been loaded so far."""

    records: list[PluginRecord] = field(default_factory=list)
    components: list[RegisteredComponent] = field(default_factory=list)
    sections: list[RegisteredSection] = field(default_factory=list)
    manager: pluggy.PluginManager = field(default_factory=lambda: pluggy.PluginManager("ncsim"))

    def __post_init__(self) -> None:
        self.manager.add_hookspecs(HookSpecs)

    def load(self, entry_point: EntryPoint, record: PluginRecord) -> None:
        """Load one entry point; on any fault, leave nothing of it but its record."""
        module: ModuleType | None = None
        try:
            module = _declaration_of(entry_point)
            api = getattr(module, "NCSIM_PLUGIN_API", None)
            record = replace(record, api=str(api or ""))
            self._register(module, api, record)
        except IncompatiblePluginError as error:
            record = replace(record, status="incompatible", detail=str(error))
        except (Exception, SystemExit) as error:  # a plug-in must not take the others down
            record = replace(record, status="failed", detail=_described(error))
        if record.is_broken and module is not None and self.manager.is_registered(module):
            self.manager.unregister(module)
        self.records.append(record)

    def _register(self, module: ModuleType, api: object, record: PluginRecord) -> None:
        fault = api_fault(api)
        if fault is not None:
            raise IncompatiblePluginError(fault)
        refuse_unmarked_hooks(module)
        self.manager.register(module, name=f"{record.distribution}:{module.__name__}")
        self.manager.check_pending()
        owner = Owner(record.distribution, record.version)
        components = declared_components(self.manager, module, owner)
        sections = declared_sections(self.manager, module, owner)
        self._refuse_clashes(components, sections)
        self.components += components
        self.sections += sections

    def _refuse_clashes(
        self, components: list[RegisteredComponent], sections: list[RegisteredSection]
    ) -> None:
        """Raise for names that cannot be told apart: in one distribution, or of sections."""
        taken = {(each.component.kind, each.qualified_name) for each in self.components}
        for new in components:
            if (new.component.kind, new.qualified_name) in taken:
                raise PluginError(f"another entry point of it has {new.component.name!r} already")
        owner_by_section = {each.section.name: each.distribution for each in self.sections}
        for section in sections:
            owner = owner_by_section.get(section.section.name)
            if owner is not None:
                raise PluginError(f"section {section.section.name!r} is taken by {owner}")


def _found_plugins() -> list[tuple[EntryPoint, PluginRecord]]:
    """Return all entry points of the group with who offers them, in load order."""
    found = [
        (entry_point, _identify(entry_point))
        for entry_point in importlib.metadata.entry_points(group=PLUGIN_GROUP)
    ]
    return sorted(
        found, key=lambda each: (each[1].distribution != CORE, each[1].distribution, each[0].name)
    )


def _declaration_of(entry_point: EntryPoint) -> ModuleType:
    loaded: object = entry_point.load()
    if not isinstance(loaded, ModuleType):
        meant = entry_point.module
        raise PluginError(
            f"its entry point is {entry_point.value!r}, which is no module; write {meant!r}"
        )
    return loaded


def _identify(entry_point: EntryPoint) -> PluginRecord:
    """Return a record with the distribution, or with the entry point's name if it has none."""
    try:
        assert entry_point.dist is not None
        return PluginRecord(normalised(entry_point.dist.name), str(entry_point.dist.version))
    except Exception:
        return PluginRecord(normalised(entry_point.name), "unknown")


def _raise_if_strict(selection: Selection, record: PluginRecord) -> None:
    if selection.is_strict and record.is_broken:
        raise PluginError(
            f"plug-in {record.distribution} {record.version} is {record.status}: {record.detail} "
            f"({STRICT_VARIABLE} is set)"
        )


def _described(error: BaseException) -> str:
    """Return an error in one line: its type matters for all but our own."""
    if isinstance(error, NcsimError):
        return str(error)
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def _names(text: str) -> frozenset[str]:
    return frozenset(normalised(name.strip()) for name in text.split(",") if name.strip())
