"""From a run of a plan to its scenario; what runs have in common is made once per process."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Generic, NamedTuple, TypeVar

from ncsim_core.errors import ScenarioError
from ncsim_core.generators.catalogue import DAGS, NETWORKS
from ncsim_core.generators.making import dags_from, depends_on_seed, network_from
from ncsim_core.generators.streams import Draws
from ncsim_core.network import Network
from ncsim_core.registry import Registry, get_registry
from ncsim_core.scenario.loader import injection_from_row, network_from_rows
from ncsim_core.scenario.model import Config, Scenario, dag_row, link_row, node_row
from ncsim_core.scenario.overrides import with_overrides
from ncsim_core.scenario.published_form import Translation, translated_config
from ncsim_core.scenario.resolution import resolve_config
from ncsim_core.sweep.axes import Run, part_of
from ncsim_core.sweep.identity import CORE, software
from ncsim_core.sweep.plan import SweepPlan, canonical
from ncsim_core.workflow import Injection

T = TypeVar("T")

CACHED_NETWORKS = 32
CACHED_CONFIGS = 4096


@dataclass(frozen=True)
class _Part(Generic[T]):
    """A part of a scenario, and what only equal parts have in common."""

    made: T
    digest: str


class _Parts(NamedTuple):
    """What a scenario is made of; the config's own seed counts for nothing."""

    network: _Part[Network]
    injections: _Part[tuple[Injection, ...]]
    config: _Part[Config]
    seed: int


class Resolver:
    """Makes the scenarios of one plan.

    Args:
        plan: The sweep.
        registry: What is installed; by default this process's registry.
    """

    def __init__(self, plan: SweepPlan, registry: Registry | None = None) -> None:
        self.plan = plan
        self._registry = registry or get_registry()
        self._network = lru_cache(CACHED_NETWORKS)(self._make_network)
        self._dags = lru_cache(CACHED_NETWORKS)(self._make_dags)
        self._config = lru_cache(CACHED_CONFIGS)(self._make_config)
        self._versions = lru_cache(CACHED_CONFIGS)(self._make_versions)

    def scenario(self, run: Run) -> Scenario:
        """Return the scenario of a run.

        Raises:
            NcsimError: The values of the run do not make a scenario.
        """
        parts = self._parts(run)
        return Scenario(
            name=self.plan.base.name,
            description="",
            network=parts.network.made,
            injections=parts.injections.made,
            config=replace(parts.config.made, seed=parts.seed),
        )

    def network(self, run: Run) -> Network:
        """Return the network of a run.

        Raises:
            NcsimError: The values of the run do not make one.
        """
        network = self.network_parameters(self.plan.values_of(run))
        seed = _seed_of(network, NETWORKS, self.plan.draw_seed(run))
        return self._network(canonical(network), seed).made

    def key(self, run: Run) -> str:
        """Return what identifies the result of a run: scenario, seed and plug-in versions.

        The scenario's name is no part of it, since it changes no result.

        Raises:
            NcsimError: The values of the run do not make a scenario.
        """
        parts = self._parts(run)
        digests = [part.digest for part in (parts.network, parts.injections, parts.config)]
        return _digest([*digests, parts.seed, self.versions(parts.config.made)])

    def _parts(self, run: Run) -> "_Parts":
        values = self.plan.values_of(run)
        seed = self.plan.draw_seed(run)
        network = self.network_parameters(values)
        dags = self.dag_parameters(values)
        overrides = {path: each for path, each in values.items() if part_of(path) == "config"}
        injections = self._dags(canonical(dags), _seed_of(dags, DAGS, seed))
        return _Parts(
            self._network(canonical(network), _seed_of(network, NETWORKS, seed)),
            injections,
            self._config(canonical(overrides), len(injections.made)),
            seed,
        )

    def versions(self, config: Config) -> str:
        """Return the packages that answer in a run, with their versions, as text."""
        names = tuple((kind, spec.name) for kind, spec in config.components.items())
        return self._versions(names)

    def _make_versions(self, names: tuple[tuple[str, str], ...]) -> str:
        owners: dict[str, set[str]] = {CORE: {"ncsim_core"}}
        for kind, name in names:
            found = self._registry.find(kind, name)
            package = found.component.factory.partition(":")[0].partition(".")[0]
            owners.setdefault(found.distribution, set()).add(package)
        texts = [software(name, tuple(sorted(packages))) for name, packages in owners.items()]
        return " ".join(sorted(texts))

    def network_parameters(self, values: Mapping[str, Any]) -> Any:  # noqa: ANN401 - plain data
        """Return the ``network`` of the base with values put in."""
        return _applied(self.plan.base.network, "network", values)

    def dag_parameters(self, values: Mapping[str, Any]) -> Any:  # noqa: ANN401 - plain data
        """Return the ``dags`` of the base with values put in."""
        return _applied(self.plan.base.dags, "dags", values)

    def _make_network(self, text: str, seed: int | None) -> _Part[Network]:
        parameters = json.loads(text)
        if "type" in parameters:
            made = network_from(parameters, Draws(seed or 0))
        else:
            is_file = "file" in parameters
            rows = self._file(parameters["file"])["network"] if is_file else parameters
            made = network_from_rows(rows)
        rows = [list(map(node_row, made.nodes)), list(map(link_row, made.links))]
        return _Part(made, _digest(rows))

    def _make_dags(self, text: str, seed: int | None) -> _Part[tuple[Injection, ...]]:
        parameters = json.loads(text)
        if isinstance(parameters, dict) and "type" in parameters:
            made = dags_from(parameters, Draws(seed or 0))
        else:
            is_file = isinstance(parameters, dict)
            rows = self._file(parameters["file"])["dags"] if is_file else parameters
            made = tuple(map(injection_from_row, rows))
        return _Part(made, _digest(list(map(dag_row, made))))

    def _file(self, name: str) -> Mapping[str, Any]:
        if name not in self.plan.base.files:
            raise ScenarioError(f"{name}: the plan does not hold this file")
        return self.plan.base.files[name]

    def _make_config(self, text: str, dag_count: int) -> _Part[Config]:
        """Return the config, its seed still to be set."""
        registry = self._registry
        rows = {"config": dict(self.plan.base.config), "dags": [None] * dag_count}
        document = with_overrides({"scenario": rows}, json.loads(text), registry)
        document = translated_config(Translation(document), document, registry).document
        made = resolve_config(document["scenario"]["config"], dag_count, registry)
        components = {kind: [each.name, each.options] for kind, each in made.components.items()}
        return _Part(made, _digest([components, made.sections]))


def _digest(data: object) -> str:
    return hashlib.sha256(canonical(data).encode()).hexdigest()


def _seed_of(parameters: Any, generators: Mapping[str, Any], seed: int) -> int | None:  # noqa: ANN401
    """Return the seed if two seeds make different things, so that equal things are made once."""
    is_generated = isinstance(parameters, dict) and "type" in parameters
    return seed if is_generated and depends_on_seed(parameters, generators) else None


def _applied(part: Any, name: str, values: Mapping[str, Any]) -> Any:  # noqa: ANN401 - plain data
    part = values.get(name, part)
    own = {path: value for path, value in values.items() if path.startswith(f"{name}.")}
    if own and isinstance(part, dict):
        part = dict(part)
        for path, value in own.items():
            part[path.partition(".")[2]] = value
    return part
