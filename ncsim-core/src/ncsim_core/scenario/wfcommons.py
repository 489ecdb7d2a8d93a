"""Reads workflows in the WfCommons format (WfFormat 1.5 and 1.6) as DAGs.

A task's cost is its measured run time times the speed of the machine that it stands for. A
dependency carries the files that one task writes and another reads. A parent that shares no file
with its child is a dependency of 0 MB; a file read by a task that does not name its writer as
parent makes a dependency too.

Source: https://wfcommons.org/format; Coleman et al., "WfCommons: A framework for enabling
scientific workflow research and development" (2022), https://doi.org/10.1016/j.future.2021.09.043.
"""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Final

from ncsim_core.scenario.faults import Data, Problem, ScenarioFaults, path_text
from ncsim_core.scenario.json_reader import RepeatedKeyError, json_positions, json_slips, read_json
from ncsim_core.scenario.positions import Span
from ncsim_core.scenario.source import Source, read_source
from ncsim_core.scenario.wfcommons_form import carried_files, workflow_problems, writers_of
from ncsim_core.workflow import DAG, DagId, Dependency, Task, TaskId

BYTES_PER_MB: Final = 1_000_000
UNITS_PER_S: Final = 100.0
"""Speed of the machine on which run times were measured, if nobody says otherwise."""


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
        ScenarioFaults: It is no such file, or its dependencies form a cycle; all faults are listed.
    """
    source = read_source(path)
    document = _read(source)
    problems = workflow_problems(document, units_per_s)
    if problems:
        raise _located(problems, source)
    name = document.get("name") or path.stem
    return _imported(document["workflow"], name, dag_id or name, units_per_s)


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
    tasks = workflow["specification"]["tasks"]
    run_time_s = {row["id"]: row["runtimeInSeconds"] for row in workflow["execution"]["tasks"]}
    files = workflow["specification"].get("files", [])
    size_bytes = {file["id"]: file["sizeInBytes"] for file in files}

    def size_MB(names: Iterable[str]) -> float:
        return float(sum(size_bytes[name] for name in names) / BYTES_PER_MB)

    dag = DAG(
        DagId(dag_id),
        tuple(Task(TaskId(each["id"]), run_time_s[each["id"]] * units_per_s) for each in tasks),
        tuple(
            Dependency(TaskId(parent), TaskId(child), size_MB(carried))
            for (parent, child), carried in carried_files(tasks).items()
        ),
    )
    written = writers_of(tasks).keys()
    read = {file for each in tasks for file in each.get("inputFiles", [])}
    return ImportedWorkflow(
        name,
        dag,
        external_MB=size_MB(name for name in size_bytes if name in read - written),
        unread_MB=size_MB(name for name in size_bytes if name in written - read),
    )
