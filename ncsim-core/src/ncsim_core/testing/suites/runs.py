"""What holds for whole runs, whatever component decides."""

from hypothesis import reject

from ncsim_core.engine.outcome import RunStatus
from ncsim_core.testing.checking import check
from ncsim_core.testing.questions import Case
from ncsim_core.testing.runs import Traced, least_makespan_us, run_with, trace_faults
from ncsim_core.testing.subject import Subject


class RunChecks:
    """Checks in which the engine asks the component, beside the plainest of the other kinds."""

    @check()
    def check_runs_obey_the_rules(self, subject: Subject, run: Case) -> None:
        """Time, tasks, bytes and rates of a run fit together, and it beats no critical path."""
        outcome, trace = _run_that_is_covered(subject, run)
        faults = trace_faults(trace)
        assert not faults, f"the trace shows: {faults[:3]}"
        assert outcome.status is not RunStatus.LIMIT_REACHED, outcome
        if outcome.makespan_us is not None and subject.component.kind != "dag_source":
            least_us = least_makespan_us(run)
            assert outcome.makespan_us >= least_us, f"{outcome.makespan_us} us, under {least_us}"

    @check()
    def check_equal_runs_leave_equal_traces(self, subject: Subject, run: Case) -> None:
        """The same scenario leaves the same trace, byte for byte."""
        first, second = run_with(subject, run), run_with(subject, run)
        assert first == second, "two runs of one scenario leave different traces"


def _run_that_is_covered(subject: Subject, case: Case) -> Traced:
    """Return a run, leaving the example out if the component says that it is not for it."""
    traced = run_with(subject, case)
    if traced.outcome.status is RunStatus.FAILED:
        detail = traced.outcome.detail
        assert str(subject.identity) not in detail, f"the engine stopped the run: {detail}"
        reject()
    return traced
