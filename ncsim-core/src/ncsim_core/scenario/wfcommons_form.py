"""What a WfCommons file must be to be read as a DAG, and where it is not."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Final, TypeAlias

from ncsim_core.scenario.faults import Data, Path, Problem
from ncsim_core.scenario.schema import ID_PATTERN
from ncsim_core.scenario.wording import Hints, cycle_text, worded
from ncsim_core.units import MAX_QUANTITY
from ncsim_core.workflow import find_cycle

MAX_DEPENDENCIES: Final = 1_000_000
"""Files that many tasks write and many read make more dependencies than a file has bytes."""

Ends: TypeAlias = tuple[str, str]
"""Ids of the producing and the waiting task of a dependency."""

_SPECIFICATION: Final[Path] = ("workflow", "specification")
_TASKS: Final[Path] = (*_SPECIFICATION, "tasks")
_MEASURED: Final[Path] = ("workflow", "execution", "tasks")
_ID: Final = {"type": "string", "pattern": ID_PATTERN}
_IDS: Final = {"type": "array", "items": _ID}
_AMOUNT: Final = {"type": "number", "minimum": 0, "maximum": MAX_QUANTITY}


def _rows(required: Mapping[str, Data], optional: Mapping[str, Data]) -> Data:
    row = {"type": "object", "required": list(required), "properties": {**required, **optional}}
    return {"type": "array", "items": row}


def _object(**properties: Data) -> Data:
    return {"type": "object", "required": list(properties), "properties": properties}


_LISTS: Final = {"children": _IDS, "inputFiles": _IDS, "outputFiles": _IDS}
_SPECIFIED: Final = _object(tasks=_rows({"id": _ID, "parents": _IDS}, _LISTS))
_SPECIFIED["properties"]["files"] = _rows({"id": _ID, "sizeInBytes": _AMOUNT}, {})
_SPECIFIED["properties"]["tasks"]["minItems"] = 1
_EXECUTED: Final = _object(tasks=_rows({"id": _ID, "runtimeInSeconds": _AMOUNT}, {}))
SCHEMA: Final = _object(workflow=_object(specification=_SPECIFIED, execution=_EXECUTED))
SCHEMA["properties"]["name"] = {"type": "string", "pattern": f"^$|{ID_PATTERN}"}
"""What is read of a workflow (draft-07); everything else in the file is passed over."""


def workflow_problems(document: Data, units_per_s: float) -> list[Problem]:
    """Return why a document cannot be read as a DAG: of its form first, then of what it says."""
    return (
        list(_form_problems(document))
        or list(_reference_problems(document["workflow"]))
        or list(_amount_problems(document["workflow"], units_per_s))
        or list(_cycle_problems(document["workflow"]["specification"]["tasks"]))
    )


def writers_of(tasks: Iterable[Data]) -> dict[str, list[str]]:
    """Return for each file the tasks that write it."""
    writers: dict[str, list[str]] = {}
    for task in tasks:
        for file in dict.fromkeys(task.get("outputFiles", [])):
            writers.setdefault(file, []).append(task["id"])
    return writers


def carried_files(tasks: list[Data]) -> dict[Ends, list[str]]:
    """Return the files on each dependency: those of named parents and children, then others."""
    writers = writers_of(tasks)
    parents: dict[str, list[str]] = {task["id"]: list(task["parents"]) for task in tasks}
    for task in tasks:
        for child in task.get("children", []):
            parents[child].append(task["id"])
    carried: dict[Ends, list[str]] = {}
    for task in tasks:
        child = task["id"]
        for parent in parents[child]:
            carried.setdefault((parent, child), [])
        for file in dict.fromkeys(task.get("inputFiles", [])):
            for writer in writers.get(file, []):
                if writer != child:
                    carried.setdefault((writer, child), []).append(file)
    return carried


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


def _reference_problems(workflow: Data) -> Iterator[Problem]:
    """Yield ids that are given twice, and names of tasks and files that are nowhere given."""
    specification = workflow["specification"]
    tasks, files = specification["tasks"], specification.get("files", [])
    yield from _repeated(tasks, _TASKS, "task")
    yield from _repeated(files, (*_SPECIFICATION, "files"), "file")
    known_tasks, known_files = (_Known(*each) for each in (("task", tasks), ("file", files)))
    for index, task in enumerate(tasks):
        for key in ("parents", "children", "inputFiles", "outputFiles"):
            known = known_files if key.endswith("Files") else known_tasks
            for place, name in enumerate(task.get(key, [])):
                path = (*_TASKS, index, key, place)
                yield from known.dangling(path, name)
                if known is known_tasks and name == task["id"]:
                    yield Problem(path, "a task must not wait for itself", name)
    yield from _run_time_problems(workflow["execution"]["tasks"], tasks, known_tasks)


def _run_time_problems(
    measured: list[Data], tasks: list[Data], known: "_Known"
) -> Iterator[Problem]:
    yield from _repeated(measured, _MEASURED, "run time of task")
    for index, row in enumerate(measured):
        yield from known.dangling((*_MEASURED, index, "id"), row["id"])
    timed = {row["id"] for row in measured}
    for index, task in enumerate(tasks):
        if task["id"] not in timed:
            message = f"task {task['id']!r} has no run time in workflow.execution.tasks"
            yield Problem((*_TASKS, index), message)


class _Known:
    """Ids of one kind of row."""

    def __init__(self, noun: str, listed: list[Data]) -> None:
        self.noun = noun
        self.ids = {row["id"] for row in listed}
        self.hints = Hints(self.ids)

    def dangling(self, path: Path, name: str) -> Iterator[Problem]:
        """Yield that ``name`` is none of the ids."""
        if name not in self.ids:
            yield Problem(path, f"no {self.noun} {name!r}", name, self.hints.hint(name))


def _repeated(rows: list[Data], path: Path, noun: str) -> Iterator[Problem]:
    seen: set[str] = set()
    for index, row in enumerate(rows):
        if row["id"] in seen:
            yield Problem((*path, index, "id"), f"{noun} {row['id']!r} is given twice", row["id"])
        seen.add(row["id"])


def _amount_problems(workflow: Data, units_per_s: float) -> Iterator[Problem]:
    """Yield costs and numbers of dependencies that are beyond all bounds."""
    for index, row in enumerate(workflow["execution"]["tasks"]):
        if row["runtimeInSeconds"] * units_per_s > MAX_QUANTITY:
            message = f"costs more than {MAX_QUANTITY:g} units at {units_per_s:g} units per second"
            yield Problem((*_MEASURED, index, "runtimeInSeconds"), message)
    tasks = workflow["specification"]["tasks"]
    writers = Counter({file: len(tasks) for file, tasks in writers_of(tasks).items()})
    count = 0
    for index, task in enumerate(tasks):
        count += sum(writers[file] for file in task.get("inputFiles", []))
        if count > MAX_DEPENDENCIES:
            message = f"up to here, files make more than {MAX_DEPENDENCIES:,} dependencies"
            yield Problem((*_TASKS, index, "inputFiles"), message)
            return


def _cycle_problems(tasks: list[Data]) -> Iterator[Problem]:
    """Yield one cycle, if there is any, at what makes a task wait for a later one of the file."""
    edges = carried_files(tasks)
    cycle = find_cycle((task["id"] for task in tasks), edges.keys())
    if cycle:
        numbers = {task["id"]: number for number, task in enumerate(tasks)}
        back = next(edge for edge in pairwise(cycle) if numbers[edge[0]] > numbers[edge[1]])
        path = _place(back, tasks, numbers, edges[back])
        yield Problem(path, f"the dependencies form a cycle: {cycle_text(cycle)}")


def _place(edge: Ends, tasks: list[Data], numbers: Mapping[str, int], files: list[str]) -> Path:
    """Return what in the document makes a dependency."""
    parent, child = edge
    if parent in tasks[numbers[child]]["parents"]:
        task, key, name = child, "parents", parent
    elif child in tasks[numbers[parent]].get("children", []):
        task, key, name = parent, "children", child
    else:
        task, key, name = child, "inputFiles", files[0]
    return (*_TASKS, numbers[task], key, tasks[numbers[task]][key].index(name))
