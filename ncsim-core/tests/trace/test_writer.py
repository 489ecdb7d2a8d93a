"""What a trace holds, byte for byte, and that writing it costs little."""

import gzip
import json
from io import StringIO

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator
from ncsim_core.engine.events import TRANSFER_COMPLETE
from ncsim_core.engine.observer import Batch, Observer
from ncsim_core.testing.whole_runs import run_cases
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.encoding import line_of, lines_of
from ncsim_core.trace.fields import RECORDS
from ncsim_core.trace.records import TraceError, TraceHeader
from ncsim_core.trace.schema import trace_schema
from ncsim_core.trace.writer import TraceWriter, rate_record


def written(case, **options):
    text = StringIO()
    case.simulation(TraceWriter(text, **options)).run()
    return text.getvalue()


def records_of(path):
    return [json.loads(line) for line in path.read_text().splitlines()[1:]]


def test_the_worked_example_is_written_as_printed(example_trace):
    lines = example_trace.read_text().splitlines()

    assert lines[1:] == [
        (
            '{"t":0,"k":"inject","d":0,"dag":"example","i0":0,"x0":0,"tasks":[["A",1.0],["B",2.0],'
            '["C",1.0],["D",1.0]],"edges":[[0,2,4.0],[1,3,1.0]]}'
        ),
        '{"t":0,"k":"place","d":0,"n":[0,1,2,2]}',
        '{"t":0,"k":"ready","i":0,"n":0}',
        '{"t":0,"k":"ready","i":1,"n":1}',
        '{"t":0,"k":"start","i":0,"n":0}',
        '{"t":0,"k":"start","i":1,"n":1}',
        '{"t":1000000,"k":"end","i":0,"n":0}',
        '{"t":1000000,"k":"xstart","x":0,"route":[0,1],"size":4.0}',
        (
            '{"t":1000000,"k":"recalc","by":["s",0],"x":[0],"r":[2.0],"l":[0],"nc":[0],"nh":[0],'
            '"fh":[1.0],"f":[1]}'
        ),
        '{"t":2000000,"k":"end","i":1,"n":1}',
        '{"t":2000000,"k":"xstart","x":1,"route":[1],"size":1.0}',
        (
            '{"t":2000000,"k":"recalc","by":["s",1],"x":[0,1],"r":[1.0,1.0],"l":[1,1],"nc":[0,0],'
            '"nh":[0,0],"fh":[1.0,1.0],"f":[2,2]}'
        ),
        '{"t":3000000,"k":"xend","x":1}',
        (
            '{"t":3000000,"k":"recalc","by":["e",1],"x":[0],"r":[2.0],"l":[0],"nc":[0],"nh":[0],'
            '"fh":[1.0],"f":[1]}'
        ),
        '{"t":3000000,"k":"ready","i":3,"n":2}',
        '{"t":3000000,"k":"start","i":3,"n":2}',
        '{"t":3500000,"k":"xend","x":0}',
        '{"t":3500000,"k":"ready","i":2,"n":2}',
        '{"t":4000000,"k":"end","i":3,"n":2}',
        '{"t":4000000,"k":"start","i":2,"n":2}',
        '{"t":5000000,"k":"end","i":2,"n":2}',
        (
            '{"t":5000000,"k":"done","status":"completed","makespan_us":5000000,"events":17,'
            '"detail":"","counts":{"inject":1,"place":1,"ready":4,"start":4,"end":4,"xstart":2,'
            '"recalc":3,"xend":2}}'
        ),
    ]


def test_the_header_names_scenario_seed_tables_and_meanings(example_trace):
    header = json.loads(example_trace.read_text().splitlines()[0])

    assert (header["format"], header["version"], header["time_unit"]) == (
        "ncsim-trace",
        "1.0",
        "us",
    )
    assert (header["scenario"], header["scenario_sha256"], header["seed"]) == ("example", "cafe", 7)
    assert header["nodes"][2] == ["c", 1.0, None, None]
    assert header["links"][1] == ["bc", 1, 2, 2.0, 0.0, "wireless"]
    assert set(header["kinds"]) == set(RECORDS)


@settings(max_examples=20, deadline=None)
@given(run_cases())
def test_equal_runs_give_equal_bytes(case):
    assert written(case) == written(case)


@settings(max_examples=25, deadline=None)
@given(run_cases())
def test_lines_are_json_without_space(case):
    for line in written(case).splitlines():
        assert json.dumps(json.loads(line), separators=(",", ":")) == line


@given(st.lists(st.floats(min_value=0.0, allow_infinity=False), min_size=1))
def test_rates_are_written_exactly_and_briefly(rates_MBps):
    count = len(rates_MBps)
    columns = ([*range(count)], rates_MBps, [0] * count, [1] * count, None)

    line = lines_of([rate_record(5, ("e", 1), columns)])

    assert json.loads(line)["r"] == rates_MBps
    assert all(len(text) <= 25 for text in line.decode().split('"r":[')[1].split("]")[0].split(","))


def test_text_that_is_half_a_character_is_written_as_its_escape():
    assert line_of({"id": "\ud800"}) == b'{"id":"\\ud800"}\n'


@settings(max_examples=12, deadline=None)
@given(run_cases())
def test_every_line_obeys_the_schema(case):
    validator = Draft202012Validator(trace_schema())
    for line in written(case).splitlines():
        validator.validate(json.loads(line))


def test_schema_is_a_schema_and_refuses_a_malformed_record():
    schema = trace_schema()
    Draft202012Validator.check_schema(schema)

    assert not Draft202012Validator(schema).is_valid({"t": 0, "k": "ready", "i": -1, "n": 0})


def test_rates_given_as_numpy_numbers_are_written_like_any_other():
    numpy = pytest.importorskip("numpy")
    text = StringIO()
    writer = TraceWriter(text)
    worked_example(writer)

    against = [numpy.int64(1)], [0], [numpy.float32(0.5)]
    columns = [numpy.int64(0)], [numpy.float64(0.1)], [numpy.int64(3)], [2], against
    writer.events_happened(Batch([(5, TRANSFER_COMPLETE, 0, 1)], {0: columns}))

    assert text.getvalue().splitlines()[2] == (
        '{"t":5,"k":"recalc","by":["e",1],"x":[0],"r":[0.1],"l":[3],"nc":[1],"nh":[0],'
        '"fh":[0.5],"f":[2]}'
    )


def test_coarse_traces_hold_no_rates(tmp_path):
    worked_example(TraceWriter(tmp_path / "t.jsonl", level="coarse")).run()

    kinds = {record["k"] for record in records_of(tmp_path / "t.jsonl")}
    assert "recalc" not in kinds
    assert "xend" in kinds


def test_compressed_traces_hold_the_same_text_and_equal_bytes(example_trace, tmp_path):
    header = TraceHeader("example", "cafe", 7)
    for name in ("one.jsonl.gz", "two.jsonl.gz"):
        worked_example(TraceWriter(tmp_path / name, header)).run()

    one, two = (tmp_path / "one.jsonl.gz").read_bytes(), (tmp_path / "two.jsonl.gz").read_bytes()
    assert one == two
    assert gzip.decompress(one) == example_trace.read_bytes()


def test_nothing_carries_the_final_name_before_the_run_has_ended(tmp_path):
    path = tmp_path / "t.jsonl"
    with TraceWriter(path) as writer:
        simulation = worked_example(writer)
        for _ in range(5):
            simulation.step()
        assert not path.exists()

    assert list(tmp_path.iterdir()) == []


def test_a_live_trace_can_be_followed_under_its_name(tmp_path):
    path = tmp_path / "t.jsonl"
    with TraceWriter(path, is_live=True) as writer:
        simulation = worked_example(writer)
        for _ in range(8):
            simulation.step()

        assert '"k":"end"' in path.read_text()


def test_the_header_of_a_live_trace_is_there_at_once(tmp_path):
    path = tmp_path / "t.jsonl"
    with TraceWriter(path, is_live=True) as writer:
        worked_example(writer).step()

        assert path.read_text().startswith('{"format":"ncsim-trace"')


def test_notes_of_plugins_are_kept_under_their_name(tmp_path):
    writer = TraceWriter(tmp_path / "t.jsonl")
    simulation = worked_example(writer)
    writer.note(0, "my-plugin", {"temperature": 21})
    simulation.run()

    note = records_of(tmp_path / "t.jsonl")[0]
    assert note == {"t": 0, "k": "note", "ns": "my-plugin", "data": {"temperature": 21}}


def test_notes_taken_while_a_run_goes_on_stand_where_they_belong(tmp_path):
    writer = TraceWriter(tmp_path / "t.jsonl")

    class Annotator(Observer):
        def task_ended(self, at_us, task, node):
            writer.note(at_us, "my-plugin", {"},\ud800": task})

    worked_example(writer, Annotator()).run()

    records = records_of(tmp_path / "t.jsonl")
    times_us = [record["t"] for record in records]
    assert times_us == sorted(times_us)
    notes = [(at, record["t"]) for at, record in enumerate(records) if record["k"] == "note"]
    ends = [(at, record["t"]) for at, record in enumerate(records) if record["k"] == "end"]
    assert [at_us for _, at_us in notes] == [at_us for _, at_us in ends]
    assert all(note > end for (note, _), (end, _) in zip(notes, ends, strict=True))
    assert records[-1]["counts"]["note"] == len(notes) == 4


def test_a_folder_that_does_not_exist_is_named(tmp_path):
    with pytest.raises(TraceError, match=r"nowhere/t\.jsonl: cannot be written"):
        TraceWriter(tmp_path / "nowhere" / "t.jsonl")


def test_a_full_disk_is_an_error_that_leaves_no_file(tmp_path, monkeypatch):
    writer = TraceWriter(tmp_path / "t.jsonl")

    def full(text):
        raise OSError(28, "No space left on device")

    simulation = worked_example(writer)
    monkeypatch.setattr(writer._sink, "_put", full)

    with pytest.raises(TraceError, match="No space left on device"):
        simulation.run()
    assert list(tmp_path.iterdir()) == []


def test_names_outside_ascii_and_lone_surrogates_survive(tmp_path):
    path = tmp_path / "t.jsonl"
    worked_example(TraceWriter(path, TraceHeader("Größe 網 \ud800"))).run()

    header = json.loads(path.read_bytes().splitlines()[0])
    assert header["scenario"] == "Größe 網 \ud800"
    assert "網" in path.read_text()
