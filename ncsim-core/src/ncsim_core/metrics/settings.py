"""What is fixed in a run, flat, so that two runs can be laid side by side."""

from collections.abc import Iterator, Mapping
from typing import Final, NamedTuple

from ncsim_core.models import ComponentIdentity
from ncsim_core.trace.run_trace import RunTrace
from ncsim_core.units import s_from_us

ABSENT: Final = "-"


class Difference(NamedTuple):
    """A setting with its value in either run, as text; ``-`` where it is absent."""

    setting: str
    first: str
    second: str


def differences(first: RunTrace, second: RunTrace) -> Iterator[Difference]:
    """Yield the settings in which two runs differ."""
    one, other = _settings(first), _settings(second)
    for setting in dict.fromkeys([*one, *other]):
        before, after = one.get(setting, ABSENT), other.get(setting, ABSENT)
        if before != after:
            yield Difference(setting, before, after)


def _settings(run: RunTrace) -> dict[str, str]:
    """Return everything that is fixed in a run, flat and as text."""
    header = run.header
    settings = {"scenario": header.scenario, "seed": str(header.seed), "software": header.software}
    for kind, identity in run.plugins.items():
        settings |= _plugin_settings(kind, identity)
    settings |= dict(_flat("", header.sections))
    settings |= {f"nodes.{node.id}": str(tuple(node[1:])) for node in run.nodes}
    for link in run.links:
        ends = f"{run.nodes[link.source].id} -> {run.nodes[link.target].id}"
        offers = f"{link.bandwidth_MBps:g} MB/s, {link.latency_s:g} s, {link.medium}"
        settings[f"links.{link.id}"] = f"{ends}, {offers}"
    for dag in run.dags:
        settings[f"dags.{dag.id}.inject_at"] = f"{s_from_us(dag.injected_us):g} s"
    return settings


def _plugin_settings(kind: str, identity: ComponentIdentity) -> dict[str, str]:
    source = f"{identity.distribution} {identity.version}"
    return {kind: identity.name, f"{kind}.source": source} | dict(_flat(kind, identity.options))


def _flat(prefix: str, mapping: Mapping[str, object]) -> Iterator[tuple[str, str]]:
    for key, value in mapping.items():
        path = f"{prefix}.{key}" if prefix else key
        if isinstance(value, dict):
            yield from _flat(path, value)
        else:
            yield path, str(value)
