"""Which components answer, once every default is decided."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from ncsim_core.plugins import KINDS
from ncsim_core.registry import RegisteredComponent, Registry
from ncsim_core.registry.option_schemas import with_defaults
from ncsim_core.scenario.faults import Data, Problem
from ncsim_core.scenario.model import DEFAULT_SEED, ComponentSpec, Config

RADIO = "radio"
NEEDS_RADIO = "needs_radio"

PREFERRED_SCHEDULER = "heft"
FALLBACK_SCHEDULER = "round_robin"

_PLAIN_DEFAULTS = {"routing_model": "direct", "interference_model": "none", "queue_model": "fifo"}


class Undecided(Exception):  # noqa: N818 - control flow within this folder, not a mistake
    """A default cannot be decided; the message tells the user what to choose."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem.message)
        self.problem = problem


def resolve_config(rows: Mapping[str, Any], dag_count: int, registry: Registry) -> Config:
    """Return the config that ``rows``, already checked against the schema, stands for.

    Raises:
        Undecided: No default fits.
        PluginError: A component is unknown or needs something that is not installed.
    """
    specs = {kind.name: _spec(kind.name, rows, dag_count, registry) for kind in KINDS.values()}
    owners = {registry.find(kind, spec.name).distribution for kind, spec in specs.items()}
    return Config(
        seed=int(rows.get("seed", DEFAULT_SEED)),
        components=specs,
        sections=_sections(rows, owners, registry),
    )


def component_name(row: object) -> str | None:
    """Return the name in a bare or a detailed component row."""
    if isinstance(row, dict):
        row = row.get("type")
    return row if isinstance(row, str) else None


def default_name(kind: str, rows: Mapping[str, Any], dag_count: int, registry: Registry) -> str:
    """Return the component that answers for ``kind`` when the scenario names none.

    Raises:
        Undecided: No default fits.
        PluginError: The interference model is unknown.
    """
    if kind == "scheduler":
        has_preferred = PREFERRED_SCHEDULER in registry.spellings("scheduler")
        return PREFERRED_SCHEDULER if has_preferred else FALLBACK_SCHEDULER
    if kind == "dag_source":
        return "single" if dag_count == 1 else "multi"
    if kind == "link_model":
        return _radio_name(registry) if wants_radio(rows, registry) else "static"
    return _PLAIN_DEFAULTS[kind]


def wants_radio(rows: Mapping[str, Any], registry: Registry) -> bool:
    """Return whether the interference model or a section asks for a radio link model.

    Raises:
        PluginError: The interference model is unknown.
    """
    name = component_name(rows.get("interference"))
    if name is not None:
        interference = registry.find("interference_model", name).component
        if NEEDS_RADIO in interference.capabilities:
            return True
    return any(
        RADIO in each.section.implies and each.section.name in rows for each in registry.sections()
    )


def _radio_name(registry: Registry) -> str:
    radios = [
        spelling
        for spelling, each in zip(
            registry.names("link_model"), registry.components("link_model"), strict=True
        )
        if RADIO in each.component.capabilities and each.is_available
    ]
    if len(radios) == 1:
        return radios[0]
    found = f"several do: {', '.join(radios)}" if radios else "no installed plug-in has one"
    raise Undecided(
        Problem(
            ("scenario", "config"),
            f"this config asks for a link model that derives rates from positions, and {found}; "
            "choose one as link_model",
        )
    )


def _spec(kind: str, rows: Mapping[str, Any], dag_count: int, registry: Registry) -> ComponentSpec:
    row = rows.get(KINDS[kind].config_key)
    name = component_name(row) or default_name(kind, rows, dag_count, registry)
    options = row.get("options", {}) if isinstance(row, dict) else {}
    return ComponentSpec(name, _options(registry.find(kind, name), options, registry))


def _options(
    registered: RegisteredComponent, options: Mapping[str, Any], registry: Registry
) -> dict[str, object]:
    resolved = registry.resolve_options(registered, options)
    return _typed(resolved, registry.options_schema(registered))


def _sections(
    rows: Mapping[str, Any], owners: Iterable[str], registry: Registry
) -> dict[str, Mapping[str, object]]:
    """Return the sections that are given, and those of the packages whose components run."""
    return {
        each.section.name: _typed(
            with_defaults(each.schema, rows.get(each.section.name, {})), each.schema
        )
        for each in registry.sections()
        if each.section.name in rows or each.distribution in owners
    }


def unused_sections(rows: Mapping[str, Any], config: Config, registry: Registry) -> Iterator[str]:
    """Yield a note for each section that is given and that none of the chosen components reads."""
    chosen = [registry.find(kind, spec.name) for kind, spec in config.components.items()]
    owners = {each.distribution for each in chosen}
    radios = [each for each in chosen if each.component.capabilities & {RADIO, NEEDS_RADIO}]
    for each in registry.sections():
        is_read = each.distribution in owners or (RADIO in each.section.implies and radios)
        if each.section.name in rows and not is_read:
            names = ", ".join(
                f"{KINDS[kind].config_key} {config.components[kind].name}"
                for kind in ("link_model", "interference_model")
            )
            yield f"config.{each.section.name} has no effect with {names}"


def _typed(values: Mapping[str, Any], schema: Mapping[str, Any]) -> dict[str, object]:
    """Return values with ``20`` and ``20.0`` made alike as the schema's type asks."""
    properties: Mapping[str, Any] = schema.get("properties", {})
    return {
        name: _as_type(value, properties.get(name, {}).get("type"))
        for name, value in values.items()
    }


def _as_type(value: Data, type_name: object) -> object:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    if type_name == "number":
        return float(value)
    return int(value) if type_name == "integer" else value
