"""Runs in the forms that other tools read."""

import csv
import json
import sys
from collections import defaultdict
from itertools import pairwise

import pytest
from hypothesis import given, settings
from ncsim_core.engine.setup import Limits
from ncsim_core.engine.simulation import Simulation
from ncsim_core.testing.builders import chain, inject, line
from ncsim_core.testing.toys import models
from ncsim_core.testing.whole_runs import run_cases
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.export.perfetto import perfetto_events, perfetto_text
from ncsim_core.trace.export.published import published_events, published_text
from ncsim_core.trace.export.tables import TABLES, write_csv, write_parquet
from ncsim_core.trace.loading import load_run
from ncsim_core.trace.recorder import RunRecorder
from ncsim_core.trace.records import TraceError
from ncsim_core.trace.writer import TraceWriter


def recorded(case):
    recorder = RunRecorder()
    case.simulation(recorder).run()
    return recorder.run_trace()


@pytest.fixture
def example_path(tmp_path):
    path = tmp_path / "trace.jsonl"
    worked_example(TraceWriter(path)).run()
    return path


def rows_of(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_the_published_form_has_its_eight_kinds_and_fields(example_path):
    events = [json.loads(each) for each in published_text(example_path).splitlines()]

    assert [event["seq"] for event in events] == list(range(19))
    assert {event["type"] for event in events} == {
        "sim_start",
        "dag_inject",
        "task_scheduled",
        "task_start",
        "task_complete",
        "transfer_start",
        "transfer_complete",
        "sim_end",
    }
    assert events[13] == {
        "seq": 13,
        "sim_time": 3.5,
        "type": "transfer_complete",
        "dag_id": "example",
        "from_task": "A",
        "to_task": "C",
        "link_id": "ab",
        "duration": 2.5,
        "route": ["ab", "bc"],
    }
    assert "route" not in events[9]  # over one link only
    assert events[-1]["makespan"] == 5.0
    assert events[-1]["total_events"] == 18


def test_a_published_transfer_begins_with_its_latency(tmp_path):
    network = line(2, latency_s=0.25)
    path = tmp_path / "t.jsonl"
    simulation = Simulation(network, models(network, [inject(chain(2))]))
    simulation.observe(TraceWriter(path))
    simulation.run()

    events = {event["type"]: event for event in published_events(path)}
    assert events["transfer_start"]["sim_time"] == 1.0
    assert events["transfer_complete"]["duration"] == 1.25


@settings(max_examples=25, deadline=None)
@given(run_cases())
def test_published_times_never_decrease_and_every_start_has_its_end(tmp_path_factory, case):
    path = tmp_path_factory.mktemp("run") / "t.jsonl"
    outcome = case.simulation(TraceWriter(path)).run()

    events = list(published_events(path))
    assert all(a["sim_time"] <= b["sim_time"] for a, b in pairwise(events))
    kinds = [event["type"] for event in events]
    if outcome.makespan_us is not None:
        assert kinds.count("task_start") == kinds.count("task_complete")
        assert kinds.count("transfer_start") == kinds.count("transfer_complete")


def test_tables_hold_the_worked_example(example_path, tmp_path):
    write_csv(load_run(example_path), tmp_path)

    tasks = {row["task"]: row for row in rows_of(tmp_path / "tasks.csv")}
    assert (tasks["C"]["ready_s"], tasks["C"]["started_s"], tasks["C"]["ended_s"]) == (
        "3.5",
        "4.0",
        "5.0",
    )
    transfers = rows_of(tmp_path / "transfers.csv")
    assert [row["route"] for row in transfers] == ["ab bc", "bc"]
    assert [row["served_MB"] for row in transfers] == ["4.0", "1.0"]


@settings(max_examples=25, deadline=None)
@given(run_cases())
def test_the_rates_table_integrates_to_what_was_served(case):
    run = recorded(case)
    served_MB = defaultdict(float)
    for row in TABLES["rates"].rows(run):
        named = dict(zip(TABLES["rates"].columns, row, strict=True))
        served_MB[named["transfer"]] += named["rate_MBps"] * (named["to_s"] - named["from_s"])

    for transfer in run.transfers:
        if transfer.steps:
            assert served_MB[transfer.number] == pytest.approx(transfer.served_MB, abs=1e-5)


def test_parquet_holds_the_same_tables_with_types(example_path, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    run = load_run(example_path)
    write_parquet(run, tmp_path)

    for name, table in TABLES.items():
        content = parquet.read_table(tmp_path / f"{name}.parquet")
        assert content.column_names == list(table.columns)
        assert content.num_rows == len(list(table.rows(run)))


def test_parquet_without_pyarrow_says_what_to_install(example_path, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)

    with pytest.raises(TraceError, match="pip install pyarrow"):
        write_parquet(load_run(example_path), tmp_path)


@settings(max_examples=40, deadline=None)
@given(run_cases())
def test_no_slices_overlap_on_any_perfetto_track(case):
    spans = defaultdict(list)
    for event in perfetto_events(recorded(case)):
        if event["ph"] == "X":
            spans[event["pid"], event["tid"]].append((event["ts"], event["ts"] + event["dur"]))

    for track in spans.values():
        assert all(a[1] <= b[0] for a, b in pairwise(sorted(track)))


def test_perfetto_text_is_json_with_arrows_and_counters(example_path):
    document = json.loads(perfetto_text(load_run(example_path)))

    phases = [event["ph"] for event in document["traceEvents"]]
    assert [phases.count(phase) for phase in "Xstf"] == [6, 2, 2, 2]
    counters = [
        (event["ts"], event["args"]["MB/s"])
        for event in document["traceEvents"]
        if event["ph"] == "C" and event["name"] == "ab MB/s"
    ]
    assert counters == [(1_000_000, 2.0), (2_000_000, 1.0), (3_000_000, 2.0), (3_500_000, 0.0)]


def test_runs_that_stopped_early_can_be_exported(tmp_path):
    whole = worked_example()
    path = tmp_path / "t.jsonl"
    limits = Limits(max_time_us=2_500_000)
    Simulation(whole.setup.network, whole.setup.models, limits, [TraceWriter(path)]).run()

    run = load_run(path)
    write_csv(run, tmp_path)
    assert json.loads(perfetto_text(run))["otherData"]["status"] == "limit_reached"
    assert list(published_events(path))[-1]["makespan"] is None
