import gzip
import zlib

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_viz.server.tail import (
    CHECKED_BYTES,
    START,
    End,
    Idle,
    Mark,
    Records,
    Restart,
    Source,
    follow,
)

HEADER = b'{"format":"ncsim-trace"}\n'
DONE = b'{"t":9,"k":"done","status":"completed"}\n'


def records(count, first=0):
    return b"".join(b'{"t":%d,"k":"ready"}\n' % number for number in range(first, first + count))


def until_idle(steps):
    """Return what comes before the next rest."""
    found = []
    for step in steps:
        if isinstance(step, Idle):
            break
        found.append(step)
    return found


def lines_of(steps):
    return b"".join(step.lines for step in steps if isinstance(step, Records))


def append(path, data):
    with path.open("ab") as file:
        file.write(data)


@pytest.fixture
def trace(tmp_path):
    path = tmp_path / "trace.jsonl"
    path.write_bytes(HEADER)
    return path


def test_a_finished_trace_is_given_whole_and_then_ends(trace):
    append(trace, records(20_000) + DONE)

    steps = list(follow(lambda: Source(trace, False)))

    assert lines_of(steps) == trace.read_bytes()
    assert steps[-1] == End("completed")
    assert len(steps) > 2  # not in one piece


def test_who_goes_on_after_the_last_record_is_told_how_the_run_ended(trace):
    append(trace, DONE.replace(b'"k"', b'"detail":"' + b"x" * 50_000 + b'","k"'))
    last = list(follow(lambda: Source(trace, False)))[-2].after

    assert list(follow(lambda: Source(trace, False), last)) == [End("completed")]


def test_a_torn_line_waits_for_its_rest(trace):
    steps = follow(lambda: Source(trace, True))
    append(trace, b'{"t":1,"k":"re')

    assert lines_of(until_idle(steps)) == HEADER
    append(trace, b'ady"}\n')
    assert lines_of(until_idle(steps)) == b'{"t":1,"k":"ready"}\n'


@given(
    pieces=st.lists(st.integers(1, 200), max_size=30),
    drops=st.sets(st.integers(0, 30), max_size=10),
)
def test_nothing_is_lost_or_repeated_however_it_is_written_and_wherever_it_breaks(
    tmp_path_factory, pieces, drops
):
    path = tmp_path_factory.mktemp("run") / "trace.jsonl"
    whole = HEADER + records(150) + DONE
    path.write_bytes(b"")
    got, mark, written = b"", START, 0
    for number, size in enumerate([*pieces, len(whole)]):
        append(path, whole[written : written + size])
        written += size
        steps = follow(lambda: Source(path, True), mark)
        for step in until_idle(steps):
            if number in drops and isinstance(step, Records):
                break  # the connection drops before these records arrive
            if isinstance(step, Records):
                got += step.lines
                mark = step.after
    rest = list(follow(lambda: Source(path, False), mark))

    assert got + lines_of(rest) == whole
    assert not any(isinstance(step, Restart) for step in rest)


def test_a_place_is_written_and_read_again():
    mark = Mark(81920, 0x3F2A9C01)

    assert str(mark) == "81920-3f2a9c01"
    assert Mark.parse(str(mark)) == mark
    assert Mark.parse("x") is Mark.parse("") is Mark.parse("٣-0") is None


def test_a_place_in_another_trace_starts_anew(trace):
    append(trace, records(100))
    old = until_idle(follow(lambda: Source(trace, True)))[-1].after
    trace.write_bytes(HEADER + records(200, first=7) + DONE)

    steps = list(follow(lambda: Source(trace, False), old))

    assert steps[0] == Restart()
    assert lines_of(steps) == trace.read_bytes()


def test_a_place_beyond_the_end_starts_anew(trace):
    steps = list(follow(lambda: Source(trace, False), Mark(10_000, 0)))

    assert steps[0] == Restart()


def test_a_run_that_gets_its_name_goes_on_without_a_break(trace, tmp_path):
    place = {"path": trace}
    steps = follow(lambda: Source(place["path"], True))
    first = until_idle(steps)
    final = tmp_path / "final"
    final.mkdir()
    place["path"] = trace.rename(final / "trace.jsonl")
    append(place["path"], DONE)

    rest = list(steps)

    assert lines_of(first) + lines_of(rest) == HEADER + DONE
    assert Restart() not in rest


def test_another_run_of_that_name_starts_anew(trace, tmp_path):
    steps = follow(lambda: Source(trace, True))
    append(trace, records(3))
    until_idle(steps)
    other = tmp_path / "other"
    other.write_bytes(HEADER + records(2, first=50) + DONE)
    other.replace(trace)

    rest = list(steps)

    assert rest[0] == Restart()
    assert lines_of(rest) == trace.read_bytes()


def test_an_equal_run_of_that_name_goes_on(trace, tmp_path):
    steps = follow(lambda: Source(trace, True))
    append(trace, records(3))
    first = until_idle(steps)
    other = tmp_path / "other"
    other.write_bytes(HEADER + records(5) + DONE)
    other.replace(trace)

    rest = list(steps)

    assert lines_of(first) + lines_of(rest) == trace.read_bytes()
    assert Restart() not in rest


def test_a_trace_whose_process_died_ends_after_its_last_record(trace):
    append(trace, records(2) + b'{"t":')

    steps = list(follow(lambda: Source(trace, False, "abandoned")))

    assert lines_of(steps) == HEADER + records(2)
    assert steps[-1] == End("abandoned")


def test_a_run_that_is_withdrawn_is_gone(trace):
    place = {"source": Source(trace, True)}
    steps = follow(lambda: place["source"])
    until_idle(steps)
    trace.unlink()
    place["source"] = None

    assert list(steps) == [End("gone")]


def test_a_trace_that_is_not_there_yet_is_waited_for(tmp_path):
    path = tmp_path / "trace.jsonl"
    steps = follow(lambda: Source(path, True))

    assert until_idle(steps) == []
    path.write_bytes(HEADER)
    assert lines_of(until_idle(steps)) == HEADER


def test_compressed_traces_are_followed_uncompressed(trace, tmp_path):
    packed = tmp_path / "t.jsonl.gz"
    packed.write_bytes(gzip.compress(HEADER + records(100) + DONE))
    half = Mark(len(HEADER), zlib.crc32(HEADER[-CHECKED_BYTES:]))

    assert lines_of(follow(lambda: Source(packed, False))) == HEADER + records(100) + DONE
    assert lines_of(follow(lambda: Source(packed, False), half)) == records(100) + DONE


def test_a_torn_compressed_trace_ends_as_truncated(tmp_path):
    packed = tmp_path / "t.jsonl.gz"
    packed.write_bytes(gzip.compress(HEADER + records(100))[:-20])

    assert list(follow(lambda: Source(packed, False)))[-1] == End("truncated")
