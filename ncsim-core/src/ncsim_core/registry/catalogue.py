"""Finds components by name and builds them, naming the plug-in to blame when that fails."""

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property

import pluggy

from ncsim_core.context import BuildContext
from ncsim_core.errors import NcsimError, PluginError, UnknownComponentError, told
from ncsim_core.models import ComponentIdentity
from ncsim_core.plugins import KINDS, RunInfo
from ncsim_core.registry.building import built, checked_options, imported
from ncsim_core.registry.messages import ambiguous_name, unknown_name
from ncsim_core.registry.option_schemas import with_defaults
from ncsim_core.registry.records import (
    OptionsSchema,
    PluginRecord,
    RegisteredComponent,
    RegisteredSection,
)


class Registry:
    """Everything that the installed plug-ins offer; never changes once it is loaded.

    Args:
        plugins: What became of each plug-in, in load order.
        components: Their components, in load order.
        sections: Their config sections, in load order.
        manager: Holds the hooks of the plug-ins that loaded.
    """

    def __init__(
        self,
        plugins: Iterable[PluginRecord],
        components: Iterable[RegisteredComponent],
        sections: Iterable[RegisteredSection],
        manager: pluggy.PluginManager,
    ) -> None:
        self._plugins = tuple(plugins)
        self._components = tuple(components)
        self._sections = tuple(sections)
        self._manager = manager
        self._spellings: dict[str, Mapping[str, RegisteredComponent]] = {}

    @property
    def plugins(self) -> tuple[PluginRecord, ...]:
        """Return what became of each plug-in, in load order."""
        return self._plugins

    def sections(self) -> tuple[RegisteredSection, ...]:
        """Return the config sections, in load order."""
        return self._sections

    def components(self, kind: str) -> tuple[RegisteredComponent, ...]:
        """Return the components of one kind in load order, unavailable ones included.

        Raises:
            UnknownComponentError: There is no such kind.
        """
        if kind not in KINDS:
            raise UnknownComponentError(f"unknown kind {kind!r}; the kinds are {', '.join(KINDS)}")
        return tuple(each for each in self._components if each.component.kind == kind)

    def spellings(self, kind: str) -> Mapping[str, RegisteredComponent]:
        """Return every valid spelling: bare names where unique, ``distribution/name`` for all."""
        known = self._spellings.get(kind)
        if known is None:
            offers = self._offers[kind] if self.components(kind) else {}
            bare = {name: each[0] for name, each in offers.items() if len(each) == 1}
            known = bare | {each.qualified_name: each for each in self.components(kind)}
            self._spellings[kind] = known
        return known

    def names(self, kind: str) -> tuple[str, ...]:
        """Return the shortest valid spelling of each component, in load order."""
        return tuple(
            each.component.name
            if len(self._offers[kind][each.component.name]) == 1
            else each.qualified_name
            for each in self.components(kind)
        )

    def lookup(self, kind: str, name: str) -> RegisteredComponent:
        """Return a component by bare or qualified name, whether or not it is available.

        Raises:
            UnknownComponentError: No plug-in offers it, or more than one does.
        """
        found = self.spellings(kind).get(name)
        if found is not None:
            return found
        rivals = self._offers.get(kind, {}).get(name, [])
        if rivals:
            raise UnknownComponentError(ambiguous_name(kind, name, rivals))
        raise UnknownComponentError(unknown_name(kind, name, self.names(kind), self._plugins))

    def find(self, kind: str, name: str) -> RegisteredComponent:
        """Return a component by bare or qualified name.

        Raises:
            UnknownComponentError: No plug-in offers it, or more than one does.
            PluginError: It needs something that is not installed.
        """
        registered = self.lookup(kind, name)
        if not registered.is_available:
            needs = ", ".join(registered.missing_requirements)
            raise PluginError(f"{kind} {registered.component.name!r}: {name} needs {needs}")
        return registered

    def options_schema(self, registered: RegisteredComponent) -> OptionsSchema:
        """Return the schema of a component's options; without any, that of an empty object."""
        return registered.schema

    def resolve_options(
        self, registered: RegisteredComponent, options: Mapping[str, object]
    ) -> dict[str, object]:
        """Return ``options`` with the schema's defaults filled in."""
        return with_defaults(registered.schema, options)

    def build(
        self, kind: str, name: str, options: Mapping[str, object], context: BuildContext
    ) -> tuple[object, ComponentIdentity]:
        """Return a component built from its options, and who it is.

        Raises:
            UnknownComponentError: No plug-in offers it, or more than one does.
            ScenarioError: An option is unknown or missing, or the component refuses its input.
            PluginError: It cannot be imported, raises, or is not what its kind promises.
        """
        build, identity = self.builder(kind, name, options, context)
        return build(), identity

    def builder(
        self, kind: str, name: str, options: Mapping[str, object], context: BuildContext
    ) -> tuple[Callable[[], object], ComponentIdentity]:
        """Return a function that builds the component anew on each call, and who it is.

        Raises:
            UnknownComponentError: No plug-in offers it, or more than one does.
            ScenarioError: An option is unknown or missing.
            PluginError: It cannot be imported. Building may raise what ``build`` raises.
        """
        registered = self.find(kind, name)
        identity = ComponentIdentity(
            kind=kind,
            name=name,
            distribution=registered.distribution,
            version=registered.version,
            factory=registered.component.factory,
            options=self.resolve_options(registered, options),
        )
        checked_options(registered, identity)
        factory = imported(registered, identity)
        return lambda: built(factory, registered, identity, context), identity

    def announce_start(self, run: RunInfo) -> None:
        """Tell the plug-ins that asked for it that a run is about to start."""
        self._announce("ncsim_run_started", run=run)

    def announce_finish(self, run: RunInfo, status: str, makespan_s: float | None) -> None:
        """Tell the plug-ins that asked for it how a run ended."""
        self._announce("ncsim_run_finished", run=run, status=status, makespan_s=makespan_s)

    def _announce(self, hook_name: str, **facts: object) -> None:
        """Call one hook of every plug-in, in load order, naming the plug-in that fails."""
        hook: pluggy.HookCaller = getattr(self._manager.hook, hook_name)
        for implementation in hook.get_hookimpls():
            arguments = {name: facts[name] for name in implementation.argnames}
            try:
                implementation.function(**arguments)
            except NcsimError:
                raise
            except (Exception, SystemExit) as error:
                owner = implementation.plugin_name.partition(":")[0]
                raise PluginError(f"plug-in {owner}: {hook_name}() raised {told(error)}") from error

    @cached_property
    def _offers(self) -> Mapping[str, Mapping[str, list[RegisteredComponent]]]:
        """Components by kind and bare name."""
        offers: dict[str, dict[str, list[RegisteredComponent]]] = {kind: {} for kind in KINDS}
        for each in self._components:
            offers[each.component.kind].setdefault(each.component.name, []).append(each)
        return offers
