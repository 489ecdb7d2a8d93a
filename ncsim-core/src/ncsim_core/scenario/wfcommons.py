"""Reads workflows in the WfCommons format (WfFormat 1.5 and 1.6) as DAGs.

A task's cost is its measured run time times the speed of the machine that it stands for. A
dependency carries the files that one task writes and another reads. A parent that shares no file
with its child is a dependency of 0 MB; a file read by a task that does not name its writer as
parent makes a dependency too.

Source: https://wfcommons.org/format; Coleman et al., "WfCommons: A framework for enabling
scientific workflow research and development" (2022), https://doi.org/10.1016/j.future.2021.09.043.
"""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, Final

from ncsim_core.errors import ScenarioError
from ncsim_core.scenario.faults import Data, Path, Problem, ScenarioFaults, path_text
from ncsim_core.scenario.json_reader import RepeatedKeyError, json_positions, json_slips, read_json
from ncsim_core.scenario.positions import Span
from ncsim_core.scenario.source import Source, read_source
from ncsim_core.scenario.wording import did_you_mean, worded
from ncsim_core.workflow import DAG, DagId, Dependency, Task, TaskId

BYTES_PER_MB: Final = 1_000_000
UNITS_PER_S: Final = 100.0
"""Speed of the machine on which run times were measured, if nobody says otherwise."""

_SPECIFICATION: Final[Path] = ("workflow", "specification")
_ID: Final = {"type": "string", "minLength": 1}
_IDS: Final = {"type": "array", "items": _ID}
_AMOUNT: Final = {"type": "number", "minimum": 0}


def _rows(required: Mapping[str, Data], optional: Mapping[str, Data]) -> Data:
    row = {"type": "object", "required": list(required), "properties": {**required, **optional}}
    return {"type": "array", "items": row}


def _object(**properties: Data) -> Data:
    return {"type": "object", "required": list(properties), "properties": properties}


_LISTS: Final = {"children": _IDS, "inputFiles": _IDS, "outputFiles": _IDS}
_SPECIFIED: Final = _object(tasks=_rows({"id": _ID, "parents": _IDS}, _LISTS)) | {}
_SPECIFIED["properties"]["files"] = _rows({"id": _ID, "sizeInBytes": _AMOUNT}, {})
_EXECUTED: Final = _object(tasks=_rows({"id": _ID, "runtimeInSeconds": _AMOUNT}, {}))
SCHEMA: Final = _object(workflow=_object(specification=_SPECIFIED, execution=_EXECUTED))
"""What is read of a workflow (draft-07); everything else in the file is passed over."""


@dataclass(frozen=True)
class ImportedWorkflow:
    """A workflow as a DAG, and what the DAG leaves out.

    Args:
        name: What the file calls it.
        dag: Its tasks in file order, its dependencies by child and then by parent.
        external_MB: Files that no task writes: nothing carries them in a run.
        unread_MB: Files that a task writes and none reads.
    """

    name: str
    dag: DAG
    external_MB: float
    unread_MB: float


def read_workflow(
    path: FilePath, *, units_per_s: float = UNITS_PER_S, dag_id: str | None = None
) -> ImportedWorkflow:
    """Return the workflow in a file.

    Args:
        path: A JSON file.
        units_per_s: Compute units per second of the machine that the run times stand for.
        dag_id: Id of the DAG; by default the workflow's name.

    Raises:
        ScenarioFaults: It is no such file; all faults are listed.
        ScenarioError: The dependencies form a cycle.
    """
    source = read_source(path)
    document = _read(source)
    problems = list(_form_problems(document)) or list(_reference_problems(document))
    if problems:
        raise _located(problems, source)
    name = str(document.get("name") or path.stem)
    try:
        return _imported(document["workflow"], name, dag_id or name, units_per_s)
    except ScenarioError as error:
        raise ScenarioError(f"{path}: {error}") from error


def _read(source: Source) -> Data:
    try:
        return read_json(source.text)
    except json.JSONDecodeError as error:
        span = Span(error.lineno, error.colno)
        raise source.lone_fault(f"not valid JSON: {error.msg}", span) from None
    except RepeatedKeyError:
        slips = json_slips(source.text)
        faults = [source.fault(path_text(each.path), each.span, each.message) for each in slips]
        raise ScenarioFaults(faults) from None
    except RecursionError:
        raise source.lone_fault("nested too deep", Span(1, 1)) from None


def _form_problems(document: Data) -> Iterator[Problem]:
    """Yield in what the document is no workflow of a version that is read here."""
    from jsonschema import Draft7Validator

    workflow = document.get("workflow") if isinstance(document, dict) else None
    if isinstance(workflow, dict) and "tasks" in workflow and "specification" not in workflow:
        version = document.get("schemaVersion", "before 1.5")
        message = f"is of format {version}; 1.5 and 1.6 are read (workflow.specification)"
        yield Problem(("workflow",), message)
        return
    for error in Draft7Validator(SCHEMA).iter_errors(document):
        yield from worded(tuple(error.absolute_path), error)


def _reference_problems(document: Data) -> Iterator[Problem]:
    """Yield ids that are given twice, and names of tasks and files that are nowhere given."""
    specification = document["workflow"]["specification"]
    tasks = specification["tasks"]
    yield from _repeated(tasks, (*_SPECIFICATION, "tasks"), "task")
    yield from _repeated(specification.get("files", []), (*_SPECIFICATION, "files"), "file")
    task_ids = {task["id"] for task in tasks}
    file_ids = {file["id"] for file in specification.get("files", [])}
    for index, task in enumerate(tasks):
        for key, known, noun in (
            ("parents", task_ids, "task"),
            ("children", task_ids, "task"),
            ("inputFiles", file_ids, "file"),
            ("outputFiles", file_ids, "file"),
        ):
            for place, name in enumerate(task.get(key, [])):
                if name not in known:
                    path = (*_SPECIFICATION, "tasks", index, key, place)
                    meant = did_you_mean(name, known)
                    yield Problem(path, f"no {noun} {name!r}", name, meant)
    yield from _run_time_problems(document, task_ids)


def _run_time_problems(document: Data, task_ids: set[str]) -> Iterator[Problem]:
    path: Path = ("workflow", "execution", "tasks")
    measured = document["workflow"]["execution"]["tasks"]
    yield from _repeated(measured, path, "run time of task")
    for index, row in enumerate(measured):
        if row["id"] not in task_ids:
            yield Problem((*path, index, "id"), f"no task {row['id']!r}", row["id"])
    timed = {row["id"] for row in measured}
    for index, task in enumerate(document["workflow"]["specification"]["tasks"]):
        if task["id"] not in timed:
            message = f"task {task['id']!r} has no run time in workflow.execution.tasks"
            yield Problem((*_SPECIFICATION, "tasks", index), message)


def _repeated(rows: list[Data], path: Path, noun: str) -> Iterator[Problem]:
    seen: set[str] = set()
    for index, row in enumerate(rows):
        if row["id"] in seen:
            yield Problem((*path, index, "id"), f"{noun} {row['id']!r} is given twice", row["id"])
        seen.add(row["id"])


def _located(problems: list[Problem], source: Source) -> ScenarioFaults:
    positions = json_positions(source.text)
    faults = [
        source.fault(
            path_text(each.path),
            positions.find(each.path),
            each.message,
            each.value,
            each.suggestion,
        )
        for each in problems
    ]
    return ScenarioFaults(sorted(faults, key=lambda each: (each.line or 0, each.column or 0)))


def _imported(workflow: Data, name: str, dag_id: str, units_per_s: float) -> ImportedWorkflow:
    rows = workflow["specification"]["tasks"]
    size_bytes = {
        file["id"]: file["sizeInBytes"] for file in workflow["specification"].get("files", [])
    }
    run_time_s = {row["id"]: row["runtimeInSeconds"] for row in workflow["execution"]["tasks"]}
    writers: dict[str, list[str]] = {}
    for row in rows:
        for file in row.get("outputFiles", []):
            writers.setdefault(file, []).append(row["id"])
    dag = DAG(
        DagId(dag_id),
        tuple(Task(TaskId(row["id"]), run_time_s[row["id"]] * units_per_s) for row in rows),
        tuple(
            Dependency(
                TaskId(parent),
                TaskId(child),
                sum(size_bytes[file] for file in files) / BYTES_PER_MB,
            )
            for (parent, child), files in _carried(rows, writers).items()
        ),
    )
    read = {file for row in rows for file in row.get("inputFiles", [])}
    return ImportedWorkflow(
        name,
        dag,
        sum(size_bytes[file] for file in size_bytes if file in read - writers.keys())
        / BYTES_PER_MB,
        sum(size_bytes[file] for file in size_bytes if file in writers.keys() - read)
        / BYTES_PER_MB,
    )


def _carried(
    rows: list[Mapping[str, Any]], writers: Mapping[str, list[str]]
) -> dict[tuple[str, str], dict[str, None]]:
    """Return the files on each dependency: those of named parents and children, then others."""
    children: dict[str, list[str]] = {}
    for row in rows:
        for child in row.get("children", []):
            children.setdefault(child, []).append(row["id"])
    carried: dict[tuple[str, str], dict[str, None]] = {}
    for row in rows:
        child = row["id"]
        for parent in (*row["parents"], *children.get(child, [])):
            carried.setdefault((parent, child), {})
        for file in row.get("inputFiles", []):
            for writer in writers.get(file, []):
                if writer != child:
                    carried.setdefault((writer, child), {})[file] = None
    return carried
