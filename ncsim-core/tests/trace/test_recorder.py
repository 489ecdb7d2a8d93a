"""A run kept in memory is the run that its trace gives."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from ncsim_core.testing.whole_runs import run_cases
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.loading import load_run
from ncsim_core.trace.recorder import RunRecorder
from ncsim_core.trace.records import TraceHeader
from ncsim_core.trace.writer import TraceWriter


@settings(max_examples=30, deadline=None)
@given(run_cases())
def test_recorded_and_reread_runs_are_equal(tmp_path_factory, case):
    path = tmp_path_factory.mktemp("run") / "t.jsonl"
    recorder = RunRecorder()
    case.simulation(recorder, TraceWriter(path)).run()

    reread, recorded = load_run(path), recorder.run_trace()
    assert replace(reread, header=TraceHeader()) == replace(recorded, header=TraceHeader())


@settings(max_examples=30, deadline=None)
@given(run_cases())
def test_served_bytes_are_those_of_the_engine(case):
    recorder = RunRecorder(keeps_steps=False)
    simulation = case.simulation(recorder)
    simulation.run()

    for transfer in recorder.run_trace().transfers:
        known = simulation.state.transfers.get(transfer.number)
        if known is not None:
            due_MB = known.rate_MBps * (simulation.state.now_us - known.credited_us) / 1e6
            left_MB = max(0.0, known.remaining_MB - due_MB)
            assert transfer.served_MB == pytest.approx(known.entry.size_MB - left_MB, abs=1e-9)


def test_a_recorder_without_steps_keeps_no_rates():
    recorder = RunRecorder(keeps_steps=False)
    worked_example(recorder).run()

    run = recorder.run_trace()
    assert not run.has_rates
    assert all(transfer.steps == () for transfer in run.transfers)


def test_a_recorder_that_has_seen_nothing_says_so():
    with pytest.raises(ValueError, match="has not seen a run yet"):
        RunRecorder().run_trace()
