"""Every trace of the engine passes the check; every broken promise is found."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_core.engine.setup import Limits
from ncsim_core.testing.whole_runs import run_cases
from ncsim_core.trace.check import check_trace, trace_report
from ncsim_core.trace.writer import TraceWriter


@settings(max_examples=40, deadline=None)
@given(
    run_cases() | run_cases(decides_routes=True),
    st.sampled_from(["full", "coarse"]),
    st.none() | st.integers(0, 40),
)
def test_every_trace_of_the_engine_passes(tmp_path_factory, case, level, max_events):
    path = tmp_path_factory.mktemp("run") / "t.jsonl"
    outcome = case.simulation(
        TraceWriter(path, level=level), limits=Limits(max_events=max_events)
    ).run()

    report = trace_report(path)
    assert report.findings == ()
    assert report.status == outcome.status


def broken(path, line, **fields):
    lines = path.read_text().splitlines()
    entry = json.loads(lines[line - 1]) | fields
    lines[line - 1] = json.dumps(entry)
    path.write_text("\n".join(lines) + "\n")
    return [finding.message for finding in check_trace(path)]


def without(path, *numbers):
    lines = path.read_text().splitlines()
    kept = [line for number, line in enumerate(lines, 1) if number not in numbers]
    path.write_text("\n".join(kept) + "\n")
    return [finding.message for finding in check_trace(path)]


@pytest.mark.parametrize(
    ("line", "fields", "message"),
    [
        (7, {"t": 2_000_000}, "time went back from 2000000 to 1000000 us"),
        (8, {"t": 1_000_001}, "task 'A' ran for 1000001 us instead of 1000000"),
        (4, {"n": 1}, "task 'A' is on node 1, but was placed on 0"),
        (16, {"i": 2}, "task 'C' is ready, but 1 inputs are not there"),
        (19, {"t": 3_500_001}, "task 'C' had all its inputs at 3500000 us"),
        (17, {"i": 2}, "task 'C' starts before it is ready"),
        (7, {"i": 0, "n": 0}, "task 'A' starts while 'A' runs on 'a'"),
        (9, {"size": 4.5}, "transfer 'A' -> 'C' carries 4.5 MB, its edge 4.0"),
        (9, {"route": [0]}, "its route does not lead to its task's node"),
        (9, {"route": [1, 0]}, "its route breaks at link 'bc'"),
        (10, {"r": [2.5]}, "link 'ab' carries 2.5 MB/s, more than its 2.0"),
        (10, {"r": [1.9]}, "transfer 'A' -> 'C' was served 3.9 MB of 4.0"),
        (
            10,
            {"by": ["e", 0]},
            "recalc is caused by the end of transfer 0, which is not just before",
        ),
        (10, {"l": [1], "f": [3]}, "3 flows on 'bc' instead of 1"),
        (13, {"l": [0, 0]}, "bottleneck 'ab' is not on its route"),
        (13, {"x": [0, 0]}, "transfer 'B' -> 'D' was served 0.0 MB of 1.0"),
        (23, {"makespan_us": 4_999_999}, "the makespan is 4999999 us, but the last task ended"),
        (23, {"status": "unroutable"}, "a run that ended unroutable has no makespan"),
        (23, {"counts": {}}, "done counts {}, the trace has"),
        (5, {"i": 9}, "task 9 has not been introduced"),
        (2, {"d": 1}, "DAG, first task and first edge are numbered (1, 0, 0), not (0, 0, 0)"),
        (3, {"n": [0]}, "1 nodes are given for 4 tasks"),
        (6, {"t": "soon"}, "start: \"t\" must be whole microseconds, not 'soon'"),
    ],
)
def test_a_broken_promise_is_found(example_trace, line, fields, message):
    assert any(message in found for found in broken(example_trace, line, **fields))


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ((23,), "the trace is truncated: it has no done record"),
        ((22,), "the run is completed, but task 'C' has not ended"),
        ((14,), "the run is completed, but transfer 'B' -> 'D' has not ended"),
        ((9,), "transfer 'A' -> 'C' gets a rate while it is not served"),
        ((8,), "transfer 'A' -> 'C' starts before its producer has ended"),
        ((6, 4), "task 'A' ends without having started"),
    ],
)
def test_a_missing_record_is_found(example_trace, lines, message):
    assert any(message in found for found in without(example_trace, *lines))


def test_latency_must_be_paid_before_bytes_are_served(example_trace):
    links = [["ab", 0, 1, 2.0, 0.25, "wireless"], ["bc", 1, 2, 2.0, 0.0, "wireless"]]

    messages = broken(example_trace, 1, links=links)
    assert messages == ["transfer 'A' -> 'C' starts before 1000000 us plus 250000 latency"]


def test_findings_name_the_line(example_trace):
    broken(example_trace, 8, t=1_000_001)

    assert check_trace(example_trace)[0].line == 8


def test_a_hopeless_trace_gives_a_bounded_number_of_findings(example_trace, monkeypatch):
    monkeypatch.setattr("ncsim_core.trace.check.MAX_FINDINGS", 3)

    assert len(without(example_trace, 4, 5, 6, 7, 8)) <= 4
