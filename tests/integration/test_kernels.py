"""Compiled kernels change how long a run takes and nothing else."""

import io
import os
import subprocess
import sys

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_core.api import prepare
from ncsim_core.engine.sessions import choice
from ncsim_core.engine.sessions.choice import may_compile, session_for
from ncsim_core.engine.sessions.kernel_session import KernelSession
from ncsim_core.engine.sessions.row_session import RowSession
from ncsim_core.generators.dags import Form, dag_of
from ncsim_core.generators.paper import paper_grid
from ncsim_core.scenario.making import make_scenario
from ncsim_core.trace.writer import TraceWriter

HAS_NUMBA = may_compile()
needs_numba = pytest.mark.skipif(not HAS_NUMBA, reason="numba is not installed")

EDGES = st.lists(st.tuples(st.integers(0, 13), st.integers(0, 13)), min_size=4, max_size=24)
RADIOS = st.fixed_dictionaries(
    {},
    optional={
        "tx_power_dBm": st.sampled_from([10.0, 16.0]),
        "rts_cts": st.just(value=True),
        "wifi_standard": st.sampled_from(["n", "ac"]),
        "shadow_fading_sigma": st.just(4.0),
    },
)


def scenario_of(size, edges, radio, floor=0.0):
    pairs = {(f"T{min(a, b)}", f"T{max(a, b)}"): None for a, b in edges if a != b}
    dag = dag_of(Form([f"T{number}" for number in range(14)], list(pairs)), dag_id="drawn")
    config = {
        "scheduler": "round_robin",
        "routing": "minimum_hop",
        "rf": radio,
        "interference": {"type": "csma_bianchi", "options": {"outage_floor_factor": floor}},
    }
    return make_scenario("drawn", paper_grid(size), [dag], config)


def trace_of(scenario, worth_kernels):
    trace = io.StringIO()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(choice, "is_worth_kernels", lambda _: worth_kernels)
        prepare(scenario, observers=[TraceWriter(trace)]).run()
    return trace.getvalue()


@needs_numba
@settings(max_examples=40, deadline=None)
@given(st.sampled_from([3, 5, 7]), EDGES, RADIOS, st.sampled_from([0.0, 0.01]))
def test_pure_and_compiled_runs_leave_the_same_trace_byte_by_byte(size, edges, radio, floor):
    scenario = scenario_of(size, edges, radio, floor)

    assert trace_of(scenario, worth_kernels=True) == trace_of(scenario, worth_kernels=False)


def model_and_tables():
    setup = prepare(scenario_of(3, [(0, 1)], {})).setup
    return setup.models.interference, setup.models.interference.tables()


@needs_numba
@pytest.mark.parametrize(
    ("pure", "refreshes", "kind"),
    [("", 10**6, KernelSession), ("", 0, RowSession), ("1", 10**6, RowSession)],
)
def test_kernels_are_for_long_runs_and_can_be_switched_off(pure, refreshes, kind, monkeypatch):
    monkeypatch.setenv("NCSIM_PURE", pure)
    monkeypatch.setattr(choice, "_refreshes_so_far", 0)
    monkeypatch.delitem(sys.modules, "numba", raising=False)

    assert type(session_for(*model_and_tables(), refreshes)) is kind


@needs_numba
def test_many_short_runs_of_a_process_are_a_long_one(monkeypatch):
    monkeypatch.setenv("NCSIM_PURE", "")
    monkeypatch.setattr(choice, "_refreshes_so_far", 0)
    monkeypatch.delitem(sys.modules, "numba", raising=False)
    worth = [choice.is_worth_kernels(choice.WORTH_KERNELS // 3) for _ in range(4)]

    assert worth == [False, False, False, True]


def test_a_short_run_does_not_import_numba():
    code = (
        "import sys; from ncsim_core import simulate;"
        "from ncsim_core.generators.paper import paper_dag, paper_grid;"
        "from ncsim_core.scenario.making import make_scenario;"
        "config = {'interference': 'csma_bianchi', 'routing': 'minimum_hop'};"
        "simulate(make_scenario('short', paper_grid(3), [paper_dag(10)], config));"
        "print('numba' in sys.modules)"
    )

    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True, text=True, check=True, env=os.environ | {"NCSIM_PURE": ""},
    )  # fmt: skip
    assert done.stdout == "False\n"


SPATIAL_TRACE = """
import sys
from ncsim_core.api import prepare
from ncsim_core.generators.paper import paper_dag, paper_grid
from ncsim_core.scenario.making import make_scenario
from ncsim_core.trace.writer import TraceWriter
config = {"scheduler": "round_robin", "routing": "widest_path", "interference": "csma_spatial"}
scenario = make_scenario("run", paper_grid(4), [paper_dag(10)], config)
prepare(scenario, observers=[TraceWriter(sys.stdout)]).run()
sys.stderr.write(f"numba={'numba' in sys.modules}")
"""


def spatial_trace(first_line, **environment):
    code = first_line + SPATIAL_TRACE
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, env=os.environ | environment, capture_output=True, check=True)
    return done.stdout, done.stderr.decode()


@needs_numba
def test_csma_spatial_leaves_the_same_trace_with_arrays_and_with_compiled_loops():
    pure, said = spatial_trace("", NCSIM_PURE="1")
    assert said == "numba=False"

    compiled, said = spatial_trace("import numba", NCSIM_PURE="")
    assert said == "numba=True"

    assert pure == compiled
