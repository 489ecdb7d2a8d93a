"""From a run of a plan to its scenario; what runs have in common is made once per process."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

from ncsim_core.errors import ScenarioError
from ncsim_core.generators.catalogue import DAGS, NETWORKS
from ncsim_core.generators.making import dags_from, depends_on_seed, network_from
from ncsim_core.generators.streams import Draws
from ncsim_core.network import Network
from ncsim_core.registry import Registry, get_registry
from ncsim_core.scenario.loader import injection_from_row, network_from_rows
from ncsim_core.scenario.model import Config, Scenario
from ncsim_core.scenario.overrides import with_overrides
from ncsim_core.scenario.published_form import Translation, translated_config
from ncsim_core.scenario.resolution import resolve_config
from ncsim_core.sweep.axes import Run, part_of
from ncsim_core.sweep.plan import SweepPlan, canonical
from ncsim_core.workflow import Injection

CACHED_NETWORKS = 32
CACHED_CONFIGS = 4096


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
        values = self.plan.values_of(run)
        seed = self.plan.draw_seed(run)
        network = self.network_parameters(values)
        dags = self.dag_parameters(values)
        overrides = {path: each for path, each in values.items() if part_of(path) == "config"}
        injections = self._dags(canonical(dags), _seed_of(dags, DAGS, seed))
        config = self._config(canonical(overrides), len(injections))
        return Scenario(
            name=self.plan.base.name,
            description="",
            network=self._network(canonical(network), _seed_of(network, NETWORKS, seed)),
            injections=injections,
            config=replace(config, seed=seed),
        )

    def key(self, run: Run) -> str:
        """Return what identifies the result of a run: scenario, seed and plug-in versions."""
        scenario = self.scenario(run)
        parts = (scenario.sha256, str(scenario.config.seed), self.versions(scenario.config))
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()

    def versions(self, config: Config) -> str:
        """Return the packages that answer in a run, with their versions, as text."""
        names = tuple((kind, spec.name) for kind, spec in config.components.items())
        return self._versions(names)

    def _make_versions(self, names: tuple[tuple[str, str], ...]) -> str:
        found = [self._registry.find(kind, name) for kind, name in names]
        owners = {f"{each.distribution}=={each.version}" for each in found}
        core = self._registry.plugins[0]
        return " ".join(sorted(owners | {f"{core.distribution}=={core.version}"}))

    def network_parameters(self, values: Mapping[str, Any]) -> Any:  # noqa: ANN401 - plain data
        """Return the ``network`` of the base with values put in."""
        return _applied(self.plan.base.network, "network", values)

    def dag_parameters(self, values: Mapping[str, Any]) -> Any:  # noqa: ANN401 - plain data
        """Return the ``dags`` of the base with values put in."""
        return _applied(self.plan.base.dags, "dags", values)

    def _make_network(self, text: str, seed: int | None) -> Network:
        parameters = json.loads(text)
        if "type" in parameters:
            return network_from(parameters, Draws(seed or 0))
        rows = self._file(parameters["file"])["network"] if "file" in parameters else parameters
        return network_from_rows(rows)

    def _make_dags(self, text: str, seed: int | None) -> tuple[Injection, ...]:
        parameters = json.loads(text)
        if isinstance(parameters, dict) and "type" in parameters:
            return dags_from(parameters, Draws(seed or 0))
        rows = (
            self._file(parameters["file"])["dags"] if isinstance(parameters, dict) else parameters
        )
        return tuple(map(injection_from_row, rows))

    def _file(self, name: str) -> Mapping[str, Any]:
        if name not in self.plan.base.files:
            raise ScenarioError(f"{name}: the plan does not hold this file")
        return self.plan.base.files[name]

    def _make_config(self, text: str, dag_count: int) -> Config:
        """Return the config, its seed still to be set."""
        registry = self._registry
        rows = {"config": dict(self.plan.base.config), "dags": [None] * dag_count}
        document = with_overrides({"scenario": rows}, json.loads(text), registry)
        document = translated_config(Translation(document), document, registry).document
        return resolve_config(document["scenario"]["config"], dag_count, registry)


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
