"""The compiled loop against the engine in Python: nothing that shows differs, to the last bit.

Without numba the same functions run as plain Python here.
"""

import contextlib
import io
import os
import subprocess
import sys
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from ncsim_core.api import result_of
from ncsim_core.contracts.scheduler import Scheduler
from ncsim_core.engine import looping
from ncsim_core.engine import simulation as simulation_module
from ncsim_core.engine.compiled import radio_loading, telling
from ncsim_core.engine.events import TRANSFER_START
from ncsim_core.engine.observer import BatchObserver
from ncsim_core.engine.outcome import RunStatus
from ncsim_core.engine.setup import Limits
from ncsim_core.engine.simulation import Simulation
from ncsim_core.errors import EngineError
from ncsim_core.network import Link, Network, Node
from ncsim_core.testing.builders import rated
from ncsim_core.testing.engine_cases import EngineCase, engine_cases
from ncsim_core.testing.toys import TabledRadio, models
from ncsim_core.trace.records import TraceError
from ncsim_core.trace.writer import TraceWriter
from ncsim_core.workflow import DAG, Dependency, Injection, Task

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
@given(
    case=engine_cases(is_compilable=True),
    events_kept=st.sampled_from((1, 3, 4096)),
    rates_kept=st.sampled_from((0, 9999)),
    matrix_links=st.sampled_from((0, 2500)),
)
def test_runs_and_traces_are_equal_to_the_last_bit(case, events_kept, rates_kept, matrix_links):
    traces = io.StringIO(), io.StringIO()
    python, seen_in_python = simulation_of(case, TraceWriter(traces[0]))
    compiled, seen = simulation_of(case, TraceWriter(traces[1]))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(telling, "EVENTS_KEPT", events_kept)
        patch.setattr(telling, "RATES_KEPT", rates_kept)
        patch.setattr(radio_loading, "MAX_LINKS_OF_MATRIX", matrix_links)

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
        patch.setattr(simulation_module, "MOST_AT_A_TIME", events)
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


class FailingObserver(BatchObserver):
    """Fails when it is told of the third start of a transfer, as a writer when the disk is full."""

    def __init__(self):
        self._started = 0

    def events_happened(self, batch):
        self._started += [kind for _, kind, _, _ in batch.events].count(TRANSFER_START)
        if self._started >= 3:
            raise TraceError("the disk is full")


class Choking(TabledRadio):
    """Fails when three links share the channel."""

    def _share(self, hidden, stations):
        if stations > 2:
            raise RuntimeError(f"{stations} are too many")
        return super()._share(hidden, stations)


def star(model=None, limits=None):
    """Return five transfers that meet on the middle node, one after the other."""
    nodes = tuple(Node(f"n{k}", 100.0) for k in range(6))
    network = rated(Network(nodes, tuple(Link(f"l{k}", f"n{k}", "n0", 1.0) for k in range(1, 6))))
    tasks = [Task("hub", 1.0, "n0"), *(Task(f"t{k}", 10.0 * k, f"n{k}") for k in range(1, 6))]
    edges = [Dependency(f"t{k}", "hub", 10.0) for k in range(1, 6)]
    injected = [Injection(0, DAG("d", tuple(tasks), tuple(edges)))]
    links = len(network.links)
    everyone = {link: range(links) for link in range(links)}
    chosen = models(network, injected, interference=(model or TabledRadio)(links, everyone))
    return EngineCase(network, chosen, limits or Limits())


ENDS = {
    "a share fails": (lambda: (star(Choking),), RunStatus.FAILED),
    "enough events": (lambda: (star(limits=Limits(max_events=7)),), RunStatus.LIMIT_REACHED),
    "no event": (lambda: (star(limits=Limits(max_events=0)),), RunStatus.LIMIT_REACHED),
    "enough time": (lambda: (star(limits=Limits(max_time_us=999)),), RunStatus.LIMIT_REACHED),
    "all done": (lambda: (star(),), RunStatus.COMPLETED),
}


@pytest.mark.parametrize("end", ENDS)
def test_every_end_is_the_same(end):
    make, status = ENDS[end]
    python, _ = simulation_of(*make())
    compiled, _ = simulation_of(*make())

    outcome = compiled.run()

    assert compiled._compiled is not None
    assert outcome == steps(python)
    assert outcome.status is status


def test_an_observer_that_fails_ends_the_run():
    python, _ = simulation_of(star(), FailingObserver())
    compiled, _ = simulation_of(star(), FailingObserver())

    for outcome in (compiled.run(), steps(python)):
        assert (outcome.status, outcome.detail) == (RunStatus.FAILED, "the disk is full")
        assert outcome.makespan_us is None


def test_who_watches_is_told_up_to_the_share_that_fails():
    traces = io.StringIO(), io.StringIO()
    python, _ = simulation_of(star(Choking), TraceWriter(traces[0]))
    compiled, _ = simulation_of(star(Choking), TraceWriter(traces[1]))

    assert compiled.run() == steps(python)
    assert traces[1].getvalue() == traces[0].getvalue()


def test_a_compiled_run_can_be_given_up():
    trace = io.StringIO()
    simulation = interrupted_after(9, simulation_of(star(), TraceWriter(trace))[0])

    simulation.give_up("no patience")

    assert simulation.outcome.status is RunStatus.LIMIT_REACHED
    assert simulation.outcome.events == 9
    assert '"events":9' in trace.getvalue()


def test_a_task_that_starts_on_a_node_of_another_is_an_engine_error():
    simulation = interrupted_after(2, simulation_of(star())[0])
    simulation._compiled._arrays["nodes"].task[:] = 0

    with pytest.raises(EngineError, match="starts on a node reserved for another"):
        simulation.run()


def test_without_numba_the_same_functions_run_as_plain_python():
    code = """
from hypothesis import Phase, given, settings
from ncsim_core.engine import looping
from ncsim_core import compiling
from ncsim_core.engine.simulation import Simulation
from ncsim_core.testing.engine_cases import engine_cases
from ncsim_core.api import result_of

assert compiling.NUMBA is None
looping.is_worth_compiling = lambda _: True

@settings(max_examples=25, database=None, derandomize=True, deadline=None, phases=[Phase.generate])
@given(engine_cases(is_compilable=True))
def agree(case):
    compiled, python = (Simulation(case.network, case.models, case.limits) for _ in range(2))
    outcome = compiled.run()
    while python.step():
        pass
    assert compiled._compiled is not None
    assert outcome == python.outcome
    assert result_of(compiled) == result_of(python)

agree()
"""
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1"}

    subprocess.run([sys.executable, "-c", code], check=True, env=environment)
