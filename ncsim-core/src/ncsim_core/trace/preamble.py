"""Reads the first line of a trace: what ran, who decided, and the tables of nodes and links."""

from collections.abc import Callable, Mapping
from typing import Final, TypeAlias, cast

from ncsim_core.models import ComponentIdentity
from ncsim_core.trace.fields import HEADER_FIELDS
from ncsim_core.trace.records import (
    FORMAT,
    TIME_UNIT,
    VERSION,
    LinkRow,
    NodeRow,
    TraceError,
    TraceHeader,
    TracePreamble,
)
from ncsim_core.trace.shapes import shown

Fault: TypeAlias = Callable[[str], TraceError]
"""Makes an error of a message by adding file and line."""

_MAJOR: Final = VERSION.partition(".")[0]


def preamble_of(entry: Mapping[str, object], fault: Fault) -> TracePreamble:
    """Return the header of a trace, checked.

    Raises:
        TraceError: It is no header, or one of another major version.
    """
    _check_format(entry, fault)
    for key, shape, _ in HEADER_FIELDS:
        if not shape.accepts(entry.get(key)):
            raise fault(f'header: "{key}" must be {shape.says}, not {shown(entry.get(key))}')
    rows = cast("Mapping[str, list[list[object]]]", entry)
    nodes = tuple(NodeRow(*row) for row in rows["nodes"])  # type: ignore[arg-type] # checked above
    links = tuple(LinkRow(*row) for row in rows["links"])  # type: ignore[arg-type] # checked above
    _check_tables(nodes, links, fault)
    return TracePreamble(
        header=_header_of(entry),
        version=str(entry["version"]),
        level=str(entry["level"]),
        plugins=_plugins_of(cast("Mapping[str, object]", entry["plugins"]), fault),
        nodes=nodes,
        links=links,
    )


def _check_format(entry: Mapping[str, object], fault: Fault) -> None:
    if entry.get("format") != FORMAT:
        hint = "; it looks like a trace of the published tool" if "sim_time" in entry else ""
        raise fault(f'this is no ncsim trace, its first line has no "format": "{FORMAT}"{hint}')
    found = entry.get("version")
    if not isinstance(found, str) or found.partition(".")[0] != _MAJOR:
        raise fault(f"version {shown(found)} of the format cannot be read, only {_MAJOR}.x")
    if entry.get("time_unit") != TIME_UNIT:
        raise fault(
            f'header: "time_unit" must be "{TIME_UNIT}", not {shown(entry.get("time_unit"))}'
        )


def _check_tables(nodes: tuple[NodeRow, ...], links: tuple[LinkRow, ...], fault: Fault) -> None:
    for node in nodes:
        if node.capacity <= 0:
            raise fault(f"header: node {node.id!r} has no capacity")
    for link in links:
        if max(link.source, link.target) >= len(nodes):
            raise fault(f"header: link {link.id!r} ends at a node that is not listed")


def _header_of(entry: Mapping[str, object]) -> TraceHeader:
    return TraceHeader(
        scenario=str(entry["scenario"]),
        scenario_sha256=str(entry["scenario_sha256"]),
        seed=cast("int", entry["seed"]),
        sections=cast("Mapping[str, object]", entry["sections"]),
        software=str(entry["software"]),
    )


def _plugins_of(plugins: Mapping[str, object], fault: Fault) -> dict[str, ComponentIdentity]:
    return {kind: _identity_of(kind, entry, fault) for kind, entry in plugins.items()}


def _identity_of(kind: str, entry: object, fault: Fault) -> ComponentIdentity:
    if not isinstance(entry, dict) or not isinstance(entry.get("options", {}), dict):
        raise fault(f"header: plug-in {shown(kind)} must be an object with an object of options")
    return ComponentIdentity(
        kind,
        name=str(entry.get("name", "unnamed")),
        distribution=str(entry.get("distribution", "unknown")),
        version=str(entry.get("version", "0")),
        factory=str(entry.get("factory", "")),
        options=entry.get("options", {}),
    )
