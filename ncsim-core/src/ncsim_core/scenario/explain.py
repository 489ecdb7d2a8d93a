"""Finds in what a document departs from the schema, each departure once and at its place."""

import math
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from typing import Any

from ncsim_core.errors import PluginError
from ncsim_core.plugins import KINDS
from ncsim_core.registry import Registry
from ncsim_core.scenario.faults import Data, Path, Problem, shown
from ncsim_core.scenario.plain_fit import plain_fit
from ncsim_core.scenario.schema import compose_schema
from ncsim_core.scenario.wording import Finding, missing_key, worded

KIND_BY_CONFIG_KEY = {kind.config_key: kind.name for kind in KINDS.values()}

CONFIG: Path = ("scenario", "config")
MAX_FINDINGS = 1000
"""Departures from the schema that are explained; each costs a millisecond."""


def schema_problems(document: Data, registry: Registry) -> list[Problem]:
    """Return everything in which ``document`` departs from the composed schema."""
    schema = compose_schema(registry)
    if plain_fit(schema)(document):
        # Of what fits plainly, only free-form options could still hide an infinite number.
        config = document["scenario"].get("config")
        return [*number_problems(config, CONFIG), *component_problems(config, registry)]
    problems: dict[tuple[Path, str], Problem] = {}
    findings = list(islice(_flat(_findings(document, schema)), MAX_FINDINGS))
    for error in _without_types_of_choices(findings):
        for problem in _problems_of(error, registry):
            problems.setdefault((problem.path, problem.message), problem)
    if len(findings) == MAX_FINDINGS:
        message = f"there may be more faults; only the first {MAX_FINDINGS} were looked at"
        problems[(), message] = Problem((), message)
    told = {path for path, _ in problems}
    others = [*number_problems(document), *component_problems(_config_of(document), registry)]
    return [
        *_without_echoes(list(problems.values())),
        *(each for each in others if each.path not in told),
    ]


def number_problems(document: Data, root: Path = ()) -> Iterator[Problem]:
    """Yield every number that is infinite or not a number; JSON Schema lets them pass."""
    waiting: list[tuple[Path, Data]] = [(root, document)]
    while waiting:
        path, value = waiting.pop()
        children: Iterable[tuple[str | int, Data]] = ()
        if isinstance(value, dict):
            children = value.items()
        elif isinstance(value, list):
            children = enumerate(value)
        elif isinstance(value, float) and not math.isfinite(value):
            yield Problem(path, f"must be a finite number, not {value}", str(value))
        waiting += [((*path, step), child) for step, child in children]


def _config_of(document: Data) -> Data:
    scenario = document.get("scenario")
    return scenario.get("config") if isinstance(scenario, dict) else None


def component_problems(config: Data, registry: Registry) -> Iterator[Problem]:
    """Yield every component that is named and cannot be had, and why."""
    for key, row in config.items() if isinstance(config, dict) else ():
        kind = KIND_BY_CONFIG_KEY.get(key)
        path: Path = (*CONFIG, key, "type") if isinstance(row, dict) else (*CONFIG, key)
        name = row.get("type") if isinstance(row, dict) else row
        if kind is not None and isinstance(name, str):
            try:
                registry.find(kind, name)
            except PluginError as error:
                yield Problem(path, str(error), shown(name))


def _findings(document: Data, schema: Mapping[str, Any]) -> Iterator[Finding]:
    """Yield what a draft-07 validator finds; it passes over list items that plainly fit."""
    from jsonschema import Draft7Validator
    from jsonschema.validators import extend

    def items(validator: Data, item_schema: Data, data: Data, _schema: Data) -> Iterator[Finding]:
        if not isinstance(data, list):
            return
        fits = plain_fit(item_schema, schema)
        for index, item in enumerate(data):
            if not fits(item):
                yield from validator.descend(item, item_schema, path=index)

    validator: Any = extend(Draft7Validator, {"items": items})  # type: ignore[no-untyped-call]
    yield from validator(schema).iter_errors(document)


def _flat(errors: Iterable[Finding]) -> Iterator[Finding]:
    """Yield errors without alternatives: of ``anyOf``, the branch that fits the data's form."""
    for error in errors:
        branch = _branch_meant(error) if error.validator == "anyOf" else []
        if branch:
            yield from _flat(branch)
        else:
            yield error


def _branch_meant(error: Finding) -> list[Finding]:
    """Return the errors of the branch for mappings, if the data is one; else none."""
    if not isinstance(error.instance, dict):
        return []
    for index, branch in enumerate(error.validator_value):
        if branch.get("type") == "object":
            return [each for each in error.context or () if each.schema_path[0] == index]
    return []


def _problems_of(error: Finding, registry: Registry) -> Iterable[Problem]:
    path: Path = tuple(error.absolute_path)
    kind = _component_kind(path)
    if kind is not None and error.validator in {"anyOf", "enum", "pattern"}:
        return [_component_problem(path, kind, error, registry)]
    return worded(path, error)


def _component_kind(path: Path) -> str | None:
    """Return the kind whose component name stands at ``path``, if one does."""
    if path[:2] != CONFIG or len(path) not in (3, 4):
        return None
    if len(path) == 4 and path[3] != "type":  # noqa: PLR2004 - config, kind, type
        return None
    return KIND_BY_CONFIG_KEY.get(str(path[2]))


def _component_problem(path: Path, kind: str, error: Finding, registry: Registry) -> Problem:
    name = error.instance
    if not isinstance(name, str):
        return Problem(path, f"must be the name of a {kind}, not {shown(name)}", shown(name))
    try:
        registry.find(kind, name)
    except PluginError as unknown:
        return Problem(path, str(unknown), shown(name))
    return Problem(path, error.message, shown(name))


def _without_types_of_choices(findings: list[Finding]) -> list[Finding]:
    """Leave out that a value has the wrong type where it is also told which ones there are."""
    chosen = {tuple(each.absolute_path) for each in findings if each.validator == "enum"}
    return [
        each
        for each in findings
        if each.validator != "type" or tuple(each.absolute_path) not in chosen
    ]


def _without_echoes(problems: list[Problem]) -> list[Problem]:
    """Leave out "'x' is missing" where a misspelt x stands beside it."""
    spelt_wrong = {
        (problem.path[:-1], missing_key(problem.suggestion))
        for problem in problems
        if problem.is_about_key and problem.suggestion is not None
    }
    return [
        each for each in problems if (each.path, each.message.partition(":")[0]) not in spelt_wrong
    ]
