"""What is fuzzed: each target takes bytes and returns, or raises what must never be raised.

Allowed is one of two outcomes: the input is accepted, or refused with one ``NcsimError`` whose text
says where. What is accepted is used, too, as far as that is cheap.
"""

import json
import re
import shutil
import sqlite3
import tempfile
from collections.abc import Callable
from itertools import islice
from pathlib import Path
from typing import Final, TypeVar

from ncsim_core.api import overridden, prepare
from ncsim_core.cli.choices import overrides_of
from ncsim_core.engine.setup import Limits
from ncsim_core.errors import NcsimError
from ncsim_core.metrics import compute_metrics
from ncsim_core.metrics.comparison import compare_runs
from ncsim_core.metrics.documents import comparison_document
from ncsim_core.metrics.explanation import explain_run
from ncsim_core.scenario.faults import ScenarioFaults
from ncsim_core.scenario.loader import load_scenario, parse_scenario
from ncsim_core.scenario.model import Scenario, dag_row
from ncsim_core.scenario.wfcommons import read_workflow
from ncsim_core.scenario.yaml_text import dump_yaml
from ncsim_core.sweep.plan import plan_from_json
from ncsim_core.sweep.reading import load_sweep
from ncsim_core.sweep.store import STORE_NAME, Store
from ncsim_core.trace.check import check_trace
from ncsim_core.trace.embedding import traces_in
from ncsim_core.trace.export.perfetto import perfetto_text
from ncsim_core.trace.export.published import published_text
from ncsim_core.trace.export.tables import write_csv
from ncsim_core.trace.loading import load_run
from ncsim_core.trace.records import TraceError
from ncsim_core.workflow import Injection
from ncsim_viz.server.scenarios import validation
from ncsim_viz.study import study_document
from ncsim_viz.terminal import TerminalSize, terminal_gantt

FOLDER: Final = Path(tempfile.mkdtemp(prefix="ncsim-fuzz-"))
MAX_RUN_SIZE: Final = 60
"""Nodes, links and tasks up to which an accepted scenario is also run for a while."""
LINE_OF_TRACE: Final = re.compile(r"trace\.jsonl(:\d+: |: (cannot be read|this run|is zstd))")


SAYS_COLUMN: Final = re.compile(r"is not varied|is no column|holds no sweep|is of format")
BASE: Final = load_scenario(Path(__file__).parents[2] / "examples" / "two_hop.yaml")
CONTRADICTION: Final = re.compile(r"contradicts itself|has no makespan")
T = TypeVar("T")


class BadRefusalError(AssertionError):
    """An error that does not say where."""


def scenario_yaml(data: bytes) -> None:
    """Read a scenario, write it out again, and run it for a while."""
    _scenario(data, FOLDER / "scenario.yaml")


def scenario_json(data: bytes) -> None:
    """As a JSON file."""
    _scenario(data, FOLDER / "scenario.json")


def published(data: bytes) -> None:
    """Read a file written for the published ncsim; the translation says what it changed."""
    _scenario(data, FOLDER / "published.yaml")


def _scenario(data: bytes, path: Path) -> None:
    path.write_bytes(data)
    try:
        scenario = load_scenario(path)
    except NcsimError as error:
        _expect_places(error)
        return
    again = parse_scenario(scenario.to_yaml())
    assert again.sha256 == scenario.sha256, "what was written out is another scenario"
    if _size(scenario) <= MAX_RUN_SIZE:
        _run(scenario)


def _size(scenario: Scenario) -> int:
    tasks = sum(len(each.dag.tasks) for each in scenario.injections)
    return len(scenario.network.nodes) + len(scenario.network.links) + tasks


def _run(scenario: Scenario) -> None:
    try:
        simulation = prepare(scenario, limits=Limits(max_events=200))
    except NcsimError:
        return
    outcome = simulation.run()
    assert (outcome.makespan_us is not None) == (outcome.status == "completed")
    assert outcome.detail or outcome.status == "completed"


def workflow(data: bytes) -> None:
    """Read a workflow of WfCommons, as ``ncsim import`` does."""
    path = FOLDER / "workflow.json"
    path.write_bytes(data)
    try:
        found = read_workflow(path)
    except NcsimError as error:
        _expect_places(error)
        return
    assert found.external_MB >= 0
    assert found.unread_MB >= 0
    dump_yaml({"dags": [dag_row(Injection(0, found.dag))]})


def sweep(data: bytes) -> None:
    """Read a sweep and list its first runs."""
    path = FOLDER / "sweep.yaml"
    path.write_bytes(data)
    try:
        plan = load_sweep(path)
    except NcsimError as error:
        _expect_places(error)
        return
    assert plan_from_json(plan.to_json()).digest == plan.digest
    for run in islice(plan.runs(), 5):
        assert len(run.values) == len(plan.columns)


def settings(data: bytes) -> None:
    """Read lines as the values of ``--set`` for a scenario."""
    lines = data.decode("utf-8", "replace").splitlines()[:8]
    try:
        changed = overridden(BASE, overrides_of(lines))
    except ScenarioFaults as error:
        if not all(fault.origin.startswith("override ") for fault in error.faults):
            raise BadRefusalError(str(error)) from error
    except NcsimError as error:
        if "--set" not in str(error):
            raise BadRefusalError(str(error)) from error
    else:
        _run(changed)


def study(data: bytes) -> None:
    """Read a study that somebody sends: the file itself, or its rows as JSON."""
    folder = FOLDER / "study"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    if data.startswith(b"SQLite"):
        (folder / STORE_NAME).write_bytes(data)
    elif not _has_filled(folder, data):
        return
    try:
        document = study_document(folder)
        with Store(folder, must_exist=True) as store, Store(None) as other:
            other.merge(store)
            errors = store.errors(9)
    except NcsimError as error:
        if STORE_NAME not in str(error) and not SAYS_COLUMN.search(str(error)):
            raise BadRefusalError(str(error)) from error
        return
    json.dumps([document, errors], allow_nan=False)


def _has_filled(folder: Path, data: bytes) -> bool:
    """Put rows that are given as JSON into a study; return whether they could be."""
    try:
        tables = json.loads(data)
        with Store(folder), sqlite3.connect(folder / STORE_NAME) as file:
            for name, columns in (("plan", 5), ("member", 5), ("result", 10)):
                marks = ", ".join("?" * columns)
                file.executemany(f"INSERT INTO {name} VALUES ({marks})", tables[name])
    except (ValueError, TypeError, LookupError, RecursionError, OverflowError, sqlite3.Error):
        return False
    return True


def posted(data: bytes) -> None:
    """Read a scenario that is posted to the viewer, and what the form makes of it."""
    try:
        body = json.loads(data)
    except (ValueError, RecursionError):
        return
    if isinstance(body, dict) and isinstance(body.get("yaml"), str):
        json.dumps(validation(body["yaml"]), allow_nan=False)
    elif isinstance(body, dict):
        assert dump_yaml(body)


def page(data: bytes) -> None:
    """Take the traces out of a report."""
    try:
        traces_in(data.decode("utf-8", "replace"))
    except TraceError as error:
        if "damaged" not in str(error):
            raise BadRefusalError(str(error)) from error


def trace(data: bytes) -> None:
    """Read a trace, check it, and use it as every verb that reads traces does."""
    path = FOLDER / "trace.jsonl"
    path.write_bytes(data)
    _tolerate(LINE_OF_TRACE, lambda: list(check_trace(path)))
    _tolerate(LINE_OF_TRACE, lambda: published_text(path))
    run = _tolerate(LINE_OF_TRACE, lambda: load_run(path))
    if run is None:
        return
    json.dumps(compute_metrics(run), allow_nan=False)
    perfetto_text(run)
    write_csv(run, FOLDER)
    terminal_gantt(run, TerminalSize(80, has_blocks=True))
    json.dumps(comparison_document(compare_runs(run, run)), allow_nan=False)
    _tolerate(CONTRADICTION, lambda: explain_run(run))


def _tolerate(wanted: re.Pattern[str], use: Callable[[], T]) -> T | None:
    """Return what a use gives; ``None`` if it is refused with the wanted words."""
    try:
        return use()
    except TraceError as error:
        if not wanted.search(str(error)):
            raise BadRefusalError(str(error)) from error
        return None


def _expect_places(error: NcsimError) -> None:
    if not isinstance(error, ScenarioFaults):
        raise BadRefusalError(f"{type(error).__name__}: {error}") from error
    without = [fault.render() for fault in error.faults if fault.line is None]
    if without or not error.faults:
        raise BadRefusalError(f"faults without a place: {without}") from error


TARGETS: Final[dict[str, Callable[[bytes], None]]] = {
    each.__name__: each
    for each in (
        *(scenario_yaml, scenario_json, published, workflow, sweep, trace),
        *(settings, study, posted, page),
    )
}
