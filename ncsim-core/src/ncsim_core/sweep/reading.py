"""Reads a sweep file; every fault is found before anything runs, and told with line and column."""

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any

from ncsim_core.errors import NcsimError
from ncsim_core.registry import Registry, get_registry
from ncsim_core.scenario.faults import Path, Problem, ScenarioFaults, shown
from ncsim_core.scenario.loader import load_scenario
from ncsim_core.scenario.published_form import translated
from ncsim_core.scenario.source import Origins, Source, located, read_document, read_source
from ncsim_core.scenario.wording import did_you_mean
from ncsim_core.sweep.axes import Axis, levels_of, repeated
from ncsim_core.sweep.checking import frame_problems, value_problems
from ncsim_core.sweep.extent import extent_problems
from ncsim_core.sweep.plan import Base, RunLimits, SweepPlan
from ncsim_core.sweep.where import ConditionError, condition, spellings

SWEEP: Path = ("sweep",)
DEFAULT_SEED = 42


def load_sweep(
    sweep: str | os.PathLike[str] | Mapping[str, Any], registry: Registry | None = None
) -> SweepPlan:
    """Return the plan of a sweep file, or of the same as plain data.

    Raises:
        ScenarioFaults: The sweep is wrong; it lists all faults.
    """
    registry = registry or get_registry()
    if isinstance(sweep, Mapping):
        return _Reading(dict(sweep), Source("sweep"), FilePath(), registry).plan("sweep")
    file = FilePath(sweep)
    source = read_source(file)
    document, slips = read_document(source)
    if slips:
        raise located([], slips, source, Origins())
    return _Reading(document, source, file.parent, registry).plan(file.stem)


class _Reading:
    """One sweep document on its way to a plan."""

    def __init__(
        self, document: dict[str, Any], source: Source, folder: FilePath, registry: Registry
    ) -> None:
        self._document = document
        self._source = source
        self._folder = folder
        self._registry = registry
        self._files: dict[str, Mapping[str, Any]] = {}
        self._parts: dict[str, Mapping[str, Any]] = {}

    def plan(self, default_name: str) -> SweepPlan:
        self._refuse(frame_problems(self._document, self._registry))
        rows: Mapping[str, Any] = self._document["sweep"]
        axes, problems = _axes(rows)
        self._refuse([*problems, *extent_problems(axes, rows)])
        columns = [path for axis in axes for path in axis.paths]
        replicate = rows.get("replicate", {})
        self._refuse([*_name_problems(columns, replicate, rows), *self._file_problems(rows, axes)])
        base = self._base(rows["base"], default_name)
        plan = SweepPlan(
            name=rows.get("name", default_name),
            description=rows.get("description", ""),
            base=base,
            axes=tuple(axes),
            seeds=_seeds(replicate.get("seeds", [base.config.get("seed", DEFAULT_SEED)])),
            pair=None if "pair" not in replicate else _pair(replicate["pair"], columns),
            limits=RunLimits(**rows.get("limits", {})),
        )
        unclear = list(_condition_problems(columns, rows))
        self._refuse([*unclear, *value_problems(plan, self._registry)])
        plan = replace(plan, where=tuple(_texts(rows.get("where", []))))
        self._refuse(_fit_problems(plan, rows))
        return plan

    def _refuse(self, problems: Sequence[Problem] | Iterator[Problem]) -> None:
        found = list(problems)
        if found:
            raise located(found, [], self._source, Origins())

    def _file_problems(self, rows: Mapping[str, Any], axes: Sequence[Axis]) -> Iterator[Problem]:
        """Take in every file that is named, and yield those that cannot be read."""
        base = rows["base"]
        if "scenario" in base:
            place: Path = ("sweep", "base", "scenario")
            yield from self._taken_in(base["scenario"], place, self._files)
        for part in ("network", "dags"):
            given = base.get(part)
            if isinstance(given, dict) and "file" in given:
                place = ("sweep", "base", part, "file")
                yield from self._taken_in(given["file"], place, self._parts)
        for name, at in _files_among(axes):
            yield from self._taken_in(name, at, self._parts)

    def _taken_in(
        self, name: str, place: Path, files: dict[str, Mapping[str, Any]]
    ) -> Iterator[Problem]:
        path = self._folder / str(name)
        try:
            load_scenario(path, registry=self._registry)
        except ScenarioFaults as error:
            for fault in error.faults:
                yield Problem(place, fault.render().partition("\n")[0], shown(name))
        except NcsimError as error:
            yield Problem(place, str(error), shown(name))
        else:
            document, _ = read_document(read_source(path))
            files[name] = translated(document, self._registry).document["scenario"]

    def _base(self, rows: Mapping[str, Any], default_name: str) -> Base:
        start = self._files[rows["scenario"]] if "scenario" in rows else {}
        return Base(
            name=start.get("name", FilePath(rows.get("scenario", default_name)).stem),
            network=rows.get("network", start.get("network")),
            dags=rows.get("dags", start.get("dags")),
            config={**start.get("config", {}), **rows.get("config", {})},
            files=self._parts,
        )


def _axes(rows: Mapping[str, Any]) -> tuple[list[Axis], list[Problem]]:
    axes: list[Axis] = []
    problems: list[Problem] = []
    for path, values in rows.get("vary", {}).items():
        place = (*SWEEP, "vary", path)
        levels, faults = levels_of(values, place)
        problems += [*faults, *_repetitions(levels, place)]
        axes.append(Axis((path,), tuple((level,) for level in levels), (place,)))
    for number, group in enumerate(rows.get("zip", [])):
        places = [(*SWEEP, "zip", number, path) for path in group]
        found = [levels_of(values, at) for values, at in zip(group.values(), places, strict=True)]
        problems += [fault for _, faults in found for fault in faults]
        if len({len(levels) for levels, _ in found}) > 1:
            lengths = ", ".join(str(len(levels)) for levels, _ in found)
            message = f"lists that go together must be equally long, not {lengths}"
            problems.append(Problem((*SWEEP, "zip", number), message))
            continue
        rows_together = tuple(zip(*(levels for levels, _ in found), strict=True))
        problems += _repetitions(rows_together, places[0])
        axes.append(Axis(tuple(group), rows_together, tuple(places)))
    return axes, problems


def _files_among(axes: Sequence[Axis]) -> Iterator[tuple[str, Path]]:
    """Yield the files that are varied, with their places: ``dags.file``, or ``dags`` as a whole."""
    for axis in axes:
        for index, path in enumerate(axis.paths):
            for number, level in enumerate(axis.levels):
                value, place = level[index], (*axis.places[index], number)
                if path in ("network.file", "dags.file"):
                    yield str(value), place
                elif path in ("network", "dags") and isinstance(value, dict) and "file" in value:
                    yield str(value["file"]), (*place, "file")


def _repetitions(levels: Sequence[Any], place: Path) -> Iterator[Problem]:
    for number in repeated(levels):
        level = levels[number]
        value = ", ".join(map(shown, level)) if isinstance(level, tuple) else shown(level)
        yield Problem((*place, number), f"{value} is listed twice; its runs would count double")


def _name_problems(
    columns: Sequence[str], replicate: Mapping[str, Any], rows: Mapping[str, Any]
) -> Iterator[Problem]:
    base = rows["base"]
    if "scenario" not in base:
        for part in ("network", "dags"):
            if part not in base and part not in columns:
                yield Problem(("sweep", "base"), f"{part!r} is missing, and no scenario is given")
    for number, group in enumerate(rows.get("zip", [])):
        for column in group:
            if columns.count(column) > 1:
                place = (*SWEEP, "zip", number, column)
                yield Problem(place, f"{column!r} is varied twice", column, is_about_key=True)
    if "seed" in columns:
        yield Problem(
            (*SWEEP, "vary", "seed"), "seeds are not varied; list them in replicate.seeds"
        )
    yield from _pair_problems(columns, replicate)


def _pair_problems(columns: Sequence[str], replicate: Mapping[str, Any]) -> Iterator[Problem]:
    names = spellings(columns)
    for number, name in enumerate(replicate.get("pair", [])):
        if name not in names:
            place = ("sweep", "replicate", "pair", number)
            yield Problem(place, f"{name!r} is not varied", name, did_you_mean(name, columns))


def _condition_problems(columns: Sequence[str], rows: Mapping[str, Any]) -> Iterator[Problem]:
    for number, text in enumerate(_texts(rows.get("where", []))):
        try:
            condition(text, columns)
        except ConditionError as error:
            is_lone = isinstance(rows["where"], str)
            yield Problem(("sweep", "where") if is_lone else ("sweep", "where", number), str(error))


def _fit_problems(plan: SweepPlan, rows: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield that a condition does not fit the values, or that no combination meets it."""
    place = (*SWEEP, "where")
    try:
        count = sum(1 for _ in plan.runs())
    except ConditionError as error:
        yield Problem(place, str(error), shown(rows["where"]))
        return
    if count == 0:
        yield Problem(place, "no combination of values meets it", shown(rows["where"]))


def _texts(where: str | list[str]) -> list[str]:
    return [where] if isinstance(where, str) else where


def _seeds(seeds: int | list[int]) -> tuple[int, ...]:
    if isinstance(seeds, list):
        return tuple(dict.fromkeys(map(int, seeds)))
    return tuple(range(1, int(seeds) + 1))


def _pair(pair: Sequence[str], columns: Sequence[str]) -> tuple[str, ...]:
    names = spellings(columns)
    return tuple(names[name] for name in pair)
