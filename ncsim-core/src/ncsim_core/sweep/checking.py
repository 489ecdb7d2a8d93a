"""What is wrong with the frame of a sweep, its generators, and each value that it varies."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from ncsim_core.errors import NcsimError
from ncsim_core.generators.catalogue import DAG_PROPERTIES, DAGS, NETWORK_PROPERTIES, NETWORKS
from ncsim_core.registry import Registry
from ncsim_core.scenario.assembly import assemble
from ncsim_core.scenario.explain import number_problems, schema_problems
from ncsim_core.scenario.faults import Path, Problem, shown
from ncsim_core.scenario.overrides import with_overrides
from ncsim_core.scenario.published_form import Translation, translated_config
from ncsim_core.scenario.wording import did_you_mean, worded
from ncsim_core.sweep.axes import Axis, Run, part_of
from ncsim_core.sweep.plan import SweepPlan
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.sweep.schema import generator_schema, structure

CONFIG: Path = ("scenario", "config")
BASE: Path = ("sweep", "base")
A_SCENARIO = "is a scenario, not a sweep; ncsim run takes it"
MAX_TRIED = 100
"""Values per axis that are put into a scenario before anything runs."""


def frame_problems(document: Mapping[str, Any], registry: Registry) -> list[Problem]:
    """Return in what a sweep departs from its schema, scenario parts aside."""
    del registry
    if "scenario" in document and "sweep" not in document:
        return [Problem(("scenario",), A_SCENARIO, is_about_key=True)]
    return list(_departures(structure(), document)) or list(number_problems(document))


def value_problems(plan: SweepPlan, registry: Registry) -> Iterator[Problem]:
    """Yield what is wrong with the base, then with each value put into it alone.

    Of an axis with very many values, some are tried, the last among them; whatever is wrong with
    another one makes failed runs.
    """
    first = Run(
        0, tuple(axis.levels[0][i] for axis in plan.axes for i in range(len(axis.paths))), 1
    )
    unknown = list(_unknown_parameters(plan, plan.values_of(first)))
    if unknown:
        yield from unknown
        return
    told: set[str] = set()
    for problem in _problems_at(plan, first, registry, None):
        told.add(problem.message)
        yield problem
    for axis in plan.axes:
        for number in _tried(len(axis.levels)):
            level = axis.levels[number]
            values = plan.values_of(first) | dict(zip(axis.paths, level, strict=True))
            run = Run(0, tuple(values[column] for column in plan.columns), 1)
            for problem in _problems_at(plan, run, registry, (axis, number)):
                if problem.message not in told:
                    told.add(problem.message)
                    yield problem


def _tried(levels: int) -> list[int]:
    """Return which values of an axis are tried, beside the first: all, or evenly spread ones.

    >>> _tried(3), len(_tried(100_000)), _tried(100_000)[-1]
    ([1, 2], 100, 99999)
    """
    if levels <= MAX_TRIED:
        return list(range(1, levels))
    return [number * (levels - 1) // MAX_TRIED for number in range(1, MAX_TRIED + 1)]


def _unknown_parameters(plan: SweepPlan, values: Mapping[str, Any]) -> Iterator[Problem]:
    for axis in plan.axes:
        for path, place in zip(axis.paths, axis.places, strict=True):
            part = part_of(path)
            if part in ("config", path):
                continue
            given = values.get(part, plan.base.network if part == "network" else plan.base.dags)
            if not isinstance(given, dict) or not {"type", "file"} & given.keys():
                message = f"{part} is not generated; only parameters of a generator can be varied"
                yield Problem(place, message, path, is_about_key=True)


def _problems_at(
    plan: SweepPlan, run: Run, registry: Registry, level: tuple[Axis, int] | None
) -> Iterator[Problem]:
    """Yield the problems of one run, at the value to blame or at the base."""
    resolver = Resolver(plan, registry)
    values = plan.values_of(run)
    network, dags = resolver.network_parameters(values), resolver.dag_parameters(values)
    found = [
        *_parameter_problems(network, "network", NETWORKS, NETWORK_PROPERTIES),
        *_parameter_problems(dags, "dags", DAGS, DAG_PROPERTIES),
    ]
    if not found:
        found = list(_scenario_problems(plan, run, resolver, registry))
    for problem in found:
        yield _placed(problem, plan, level)


def _parameter_problems(
    parameters: Any,  # noqa: ANN401 - plain data
    part: str,
    generators: Mapping[str, Any],
    common: Mapping[str, Any],
) -> Iterator[Problem]:
    if not isinstance(parameters, dict) or "type" not in parameters:
        return
    name = parameters["type"]
    if name not in generators:
        known = ", ".join(generators)
        message = f"no generator {name!r}; there are {known}"
        meant = did_you_mean(name, generators)
        yield Problem(("scenario", part, "type"), message, shown(name), meant)
        return
    schema = generator_schema(generators[name], common)
    for problem in _departures(schema, parameters):
        yield Problem(
            ("scenario", part, *problem.path),
            problem.message,
            problem.value,
            problem.suggestion,
            problem.is_about_key,
        )


def _scenario_problems(
    plan: SweepPlan, run: Run, resolver: Resolver, registry: Registry
) -> Iterator[Problem]:
    document = {"network": {"nodes": [{"id": "n", "compute_capacity": 1}]}}
    rows: dict[str, Any] = {
        **document,
        "dags": [{"id": "d", "tasks": [{"id": "t", "compute_cost": 1}]}],
    }
    rows["config"] = dict(plan.base.config)
    overrides = {k: v for k, v in plan.values_of(run).items() if part_of(k) == "config"}
    whole = with_overrides({"scenario": rows}, overrides, registry)
    translation = translated_config(Translation(whole), whole, registry)
    problems = [*translation.problems, *schema_problems(translation.document, registry)]
    yield from problems
    if not problems:
        yield from _making_problems(run, resolver, registry)


def _making_problems(run: Run, resolver: Resolver, registry: Registry) -> Iterator[Problem]:
    """Yield what keeps network, DAGs and models from being made."""
    steps: tuple[tuple[Path, Callable[[], object]], ...] = (
        (("scenario", "network"), lambda: resolver.network(run)),
        (("scenario", "dags"), lambda: resolver.scenario(run)),
        (("scenario",), lambda: assemble(resolver.scenario(run), registry)),
    )
    for path, make in steps:
        try:
            make()
        except NcsimError as error:
            yield Problem(path, str(error))
            return
        except (AttributeError, KeyError, TypeError, ValueError) as error:
            yield Problem(path, f"these rows are no scenario: {error!r}")
            return


def _placed(problem: Problem, plan: SweepPlan, level: tuple[Axis, int] | None) -> Problem:
    """Return a problem of a scenario where the sweep file has its cause."""
    inner = problem.path[1:]
    dotted = ".".join(map(str, inner[1:] if inner[:1] == ("config",) else inner))
    for axis in plan.axes:
        for path, place in zip(axis.paths, axis.places, strict=True):
            if problem.is_about_key and path.startswith(dotted):
                meant = problem.suggestion or did_you_mean(dotted, ("network", "dags"))
                return Problem(place, problem.message, path, meant, is_about_key=True)
            if dotted == path or dotted.startswith(f"{path}."):
                number = level[1] if level is not None and level[0] is axis else 0
                return _moved(problem, (*place, number))
    if level is not None and len(problem.path) == 1:
        return _moved(problem, (*level[0].places[0], level[1]))
    return _moved(problem, (*BASE, *inner))


def _moved(problem: Problem, path: Path) -> Problem:
    is_about_key = problem.is_about_key and path[:2] == BASE
    return Problem(path, problem.message, problem.value, problem.suggestion, is_about_key)


def _departures(schema: Mapping[str, Any], data: object) -> Iterator[Problem]:
    from jsonschema import Draft7Validator

    for error in Draft7Validator(schema).iter_errors(data):
        yield from worded(tuple(error.absolute_path), error)
