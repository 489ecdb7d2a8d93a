"""Traces are read as a stream, and garbage is refused with file and line."""

import gzip
import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.loading import load_run
from ncsim_core.trace.reader import read_trace
from ncsim_core.trace.records import Done, TraceError
from ncsim_core.trace.writer import TraceWriter


def kinds(path):
    return [type(record).__name__ for record in read_trace(path)]


def outcome_of(path):
    """Return how a run ended and what was wrong with its trace; one of them is empty."""
    try:
        return load_run(path).end.status, ""
    except TraceError as error:
        return "", str(error)


def changed(path, line, **fields):
    """Return the trace with some fields of one line (counted from 1) changed; None removes."""
    lines = path.read_text().splitlines()
    entry = json.loads(lines[line - 1])
    for key, value in fields.items():
        entry[key] = value
        if value is None:
            del entry[key]
    lines[line - 1] = json.dumps(entry)
    path.write_text("\n".join(lines) + "\n")
    return path


def test_a_whole_trace_is_read_in_order(example_trace):
    reader = read_trace(example_trace)
    records = list(reader)

    assert len(records) == 22
    assert isinstance(records[-1], Done)
    assert [record.line for record in records] == list(range(2, 24))
    assert not reader.is_truncated
    assert reader.preamble.nodes[0].id == "a"


def test_a_folder_means_the_trace_inside(example_trace):
    assert len(kinds(example_trace.parent)) == 22


def test_a_folder_without_a_trace_is_said_to_have_none(tmp_path):
    with pytest.raises(TraceError, match=r"holds no trace\.jsonl or trace\.jsonl\.gz"):
        read_trace(tmp_path)


def test_compression_is_told_by_contents_not_by_name(example_trace, tmp_path):
    path = tmp_path / "renamed"
    path.write_bytes(gzip.compress(example_trace.read_bytes()))

    assert len(kinds(path)) == 22


@settings(max_examples=80, deadline=None)
@given(st.data())
def test_a_trace_cut_anywhere_opens_as_truncated_or_is_refused(tmp_path_factory, data):
    whole = _example_bytes(tmp_path_factory)
    is_gzip = data.draw(st.booleans())
    content = gzip.compress(whole, mtime=0) if is_gzip else whole
    size = data.draw(st.integers(0, len(content) - 2))
    path = tmp_path_factory.mktemp("cut") / "t.jsonl"
    path.write_bytes(content[:size])

    status, fault = outcome_of(path)
    assert fault.startswith(f"{path}:1: ") or status == "truncated" or is_gzip


_CACHE = {}


def _example_bytes(factory):
    """Return the bytes of a small trace, made once."""
    if not _CACHE:
        path = factory.mktemp("whole") / "t.jsonl"
        worked_example(TraceWriter(path)).run()
        _CACHE["bytes"] = path.read_bytes()
    return _CACHE["bytes"]


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_any_damage_is_read_or_refused_but_never_a_traceback(tmp_path_factory, data):
    content = bytearray(_example_bytes(tmp_path_factory))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(content) - 1))
        junk = data.draw(st.sampled_from([b"", b"9", b"-", b"{", b"[", b'"', b"\xff", b"1e999"]))
        content[at : at + data.draw(st.integers(0, 3))] = junk
    path = tmp_path_factory.mktemp("damaged") / "t.jsonl"
    path.write_bytes(bytes(content))

    status, fault = outcome_of(path)
    assert status or fault.startswith(f"{path}:")


@settings(max_examples=60, deadline=None)
@given(st.binary(max_size=200))
def test_random_bytes_are_refused(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("random") / "t.jsonl"
    path.write_bytes(content)

    with pytest.raises(TraceError):
        load_run(path)


@pytest.mark.parametrize(
    ("line", "fields", "message"),
    [
        (1, {"format": "other"}, "no ncsim trace"),
        (1, {"version": "2.0"}, "version '2.0' of the format cannot be read, only 1.x"),
        (1, {"version": 1}, "version 1 of the format"),
        (1, {"time_unit": "s"}, '"time_unit" must be "us", not \'s\''),
        (1, {"nodes": [["a"]]}, '"nodes" must be a list of .id, capacity'),
        (1, {"nodes": [["a", 0, None, None]]}, "node 'a' has no capacity"),
        (1, {"links": [["ab", 0, 9, 1.0, 0.0, "wired"]]}, "link 'ab' ends at a node"),
        (1, {"plugins": {"scheduler": 3}}, "plug-in 'scheduler' must be an object"),
        (1, {"seed": None}, '"seed" must be a whole number, not None'),
        (4, {"t": -1}, 'ready: "t" must be whole microseconds, not -1'),
        (4, {"t": 1.5}, 'ready: "t" must be whole microseconds, not 1.5'),
        (4, {"k": 3}, '"k" must name the kind of record, not 3'),
        (4, {"i": None}, 'ready: "i" is missing'),
        (4, {"i": True}, 'ready: "i" must be a whole number, 0 or more, not True'),
        (4, {"i": 4}, "task 4 has not been introduced; there are 4"),
        (4, {"n": 3}, "node 3 has not been introduced; there are 3"),
        (3, {"n": [0, 1]}, "place: 2 nodes for 4 tasks"),
        (2, {"i0": 5}, "inject: DAG, first task and first edge must be numbered 0, 0 and 0"),
        (2, {"edges": [[0, 7, 1.0]]}, "inject: edge 0 -> 7 leaves its DAG"),
        (9, {"route": [0, 2]}, "link 2 has not been introduced"),
        (9, {"route": []}, "the route is empty"),
        (10, {"r": [1.0, 2.0]}, "recalc: its lists must be equally long"),
        (10, {"r": [1e101]}, '"r" must be a list of numbers from 0 to 1e.100'),
        (13, {"l": [1, 0]}, "recalc: bottleneck 0 is not on the route of transfer 1"),
        (10, {"t": 2**63}, 'recalc: "t" must be whole microseconds'),
        (10, {"by": ["x", 0]}, '"by" must be a pair'),
        (14, {"x": 2}, "transfer 2 has not been introduced"),
    ],
)
def test_faults_are_named_with_file_and_line(example_trace, line, fields, message):
    path = changed(example_trace, line, **fields)

    with pytest.raises(TraceError, match=f":{line}: .*{message.replace('[', '.')}"):
        load_run(path)


@pytest.mark.parametrize("text", ["NaN", "Infinity", "nonsense", "[1]", "{" * 5000, "9" * 5000])
def test_a_line_that_is_no_record_is_shown(example_trace, text):
    lines = example_trace.read_text().splitlines()
    lines[4] = text
    example_trace.write_text("\n".join(lines) + "\n")

    with pytest.raises(TraceError, match=r"trace\.jsonl:5: "):
        load_run(example_trace)


def test_kinds_and_fields_of_a_later_minor_version_are_ignored(example_trace):
    changed(example_trace, 1, version="1.7", novelty=True)
    changed(example_trace, 4, novelty=[1])
    lines = example_trace.read_text().splitlines()
    lines.insert(4, '{"t":0,"k":"weather","rain":true}')
    example_trace.write_text("\n".join(lines) + "\n")

    assert len(kinds(example_trace)) == 22


def test_records_after_done_are_refused(example_trace):
    with example_trace.open("a") as file:
        file.write('{"t":9000000,"k":"xend","x":0}\n')

    with pytest.raises(TraceError, match="nothing may follow the done record"):
        kinds(example_trace)


def test_a_trace_of_the_published_tool_is_recognised(tmp_path):
    path = tmp_path / "t.jsonl"
    path.write_text('{"sim_time":0.0,"type":"sim_start","seq":0}\n')

    with pytest.raises(TraceError, match="it looks like a trace of the published tool"):
        read_trace(path)


def test_an_endless_line_is_refused_without_reading_it_all(tmp_path, monkeypatch):
    monkeypatch.setattr("ncsim_core.trace.reader.MAX_LINE_BYTES", 1000)
    path = tmp_path / "t.jsonl"
    path.write_bytes(b"x" * 5000)

    with pytest.raises(TraceError, match="longer than 1000 bytes"):
        read_trace(path)
