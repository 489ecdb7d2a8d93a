"""The compiled loop against the engine in Python: nothing that shows differs, to the last bit.

Without numba the same functions run as plain Python here.
"""

import contextlib
import io
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from ncsim_core.api import result_of
from ncsim_core.contracts.scheduler import Scheduler
from ncsim_core.engine import looping
from ncsim_core.engine import simulation as simulation_module
from ncsim_core.engine.compiled import telling
from ncsim_core.engine.simulation import Simulation
from ncsim_core.testing.engine_cases import engine_cases
from ncsim_core.trace.writer import TraceWriter

IS_NIGHTLY = settings.get_current_profile_name() == "nightly"


class Witness(Scheduler):
    """Keeps what another scheduler is shown."""

    def __init__(self, scheduler):
        self._scheduler = scheduler
        self.seen = []

    def schedule(self, dag, snapshot):
        self.seen.append((snapshot.now_s, snapshot.queue_depths, snapshot.active_transfers))
        return self._scheduler.schedule(dag, snapshot)


def simulation_of(case, *observers):
    witness = Witness(case.models.scheduler)
    models = replace(case.models, scheduler=witness)
    return Simulation(case.network, models, case.limits, observers), witness


@pytest.fixture(autouse=True)
def _compiles(monkeypatch):
    monkeypatch.setattr(looping, "is_worth_compiling", lambda _: True)


def steps(simulation):
    """Run event by event in Python."""
    while simulation.step():
        pass
    assert simulation._compiled is None
    return simulation.outcome


def picture(state):
    """Return all that a state holds."""
    tasks = [
        (run.missing, run.node, run.status, run.ready_us, run.started_us, run.ended_us)
        for run in state.tasks
    ]
    return (
        (state.now_us, state.events, state.unfinished_tasks, state.last_task_end_us),
        (state.free_tasks_placed, state.unroutable),
        tasks,
        [picture_of_transfer(transfer) for transfer in state.transfers.values()],
        sorted(state.flows),
        [(node.task, len(node.queue)) for node in state.nodes],
        [list(flows) for flows in state.links.flows],
        [f for f, flows in zip(state.links.factor, state.links.flows, strict=True) if flows],
        [s for s, flows in zip(state.links.share_MBps, state.links.flows, strict=True) if flows],
        state.served_MB(),
    )


def picture_of_transfer(flow):
    return (
        (flow.number, flow.route, flow.remaining_MB, flow.rate_MBps, flow.bottleneck),
        (flow.created_us, flow.credited_us, flow.started_us, flow.ended_us),
    )


@settings(max_examples=5_000 if IS_NIGHTLY else 200, suppress_health_check=[*HealthCheck])
@given(engine_cases(is_compilable=True), st.sampled_from((1, 3, 4096)), st.sampled_from((0, 9999)))
def test_runs_and_traces_are_equal_to_the_last_bit(case, events_kept, rates_kept):
    traces = io.StringIO(), io.StringIO()
    python, seen_in_python = simulation_of(case, TraceWriter(traces[0]))
    compiled, seen = simulation_of(case, TraceWriter(traces[1]))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(telling, "EVENTS_KEPT", events_kept)
        patch.setattr(telling, "RATES_KEPT", rates_kept)

        outcome = compiled.run()

    assert compiled._compiled is not None
    assert outcome == steps(python)
    assert result_of(compiled) == result_of(python)
    assert picture(compiled.state) == picture(python.state)
    assert seen.seen == seen_in_python.seen
    assert traces[1].getvalue() == traces[0].getvalue()


def interrupted_after(events, simulation):
    """Return a simulation whose compiled run somebody has interrupted."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(simulation_module, "EVENTS_AT_A_TIME", events)
        patch.setattr(Simulation, "_handle_compiled", interrupting(Simulation._handle_compiled))
        with contextlib.suppress(KeyboardInterrupt):
            simulation.run()
    return simulation


def interrupting(handle):
    def handle_and_raise(*arguments):
        handle(*arguments)
        raise KeyboardInterrupt

    return handle_and_raise


@settings(max_examples=2_000 if IS_NIGHTLY else 80, suppress_health_check=[*HealthCheck])
@given(engine_cases(is_compilable=True), st.integers(1, 200))
def test_an_interrupted_run_has_the_state_of_that_event_and_goes_on_from_there(case, events):
    python, _ = simulation_of(case)
    for _ in range(events):
        python.step()
    compiled, _ = simulation_of(case)

    interrupted_after(events, compiled)

    assert picture(compiled.state) == picture(python.state)
    while python.outcome is None:
        assert compiled.step() == python.step()
        assert picture(compiled.state) == picture(python.state)
    assert compiled.outcome == python.outcome


@settings(max_examples=2_000 if IS_NIGHTLY else 80, suppress_health_check=[*HealthCheck])
@given(engine_cases(is_compilable=True), st.integers(1, 200))
def test_the_engine_in_python_could_go_on_from_the_state_of_a_compiled_run(case, events):
    python, _ = simulation_of(case)
    handed_over, _ = simulation_of(case)
    interrupted_after(events, handed_over)

    assert handed_over.state is not None  # brings it up to date
    handed_over._compiled = None

    assert steps(handed_over) == steps(python)
    assert picture(handed_over.state) == picture(python.state)
