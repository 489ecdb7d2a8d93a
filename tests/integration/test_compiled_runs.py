"""Compiled loops change how long a run takes and nothing else."""

import io
import os
import random
import subprocess
import sys

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_core.acceleration import may_compile
from ncsim_core.api import prepare
from ncsim_core.engine import looping
from ncsim_core.engine.observer import Observer
from ncsim_core.generators.dags import Form, dag_of
from ncsim_core.generators.paper import paper_grid
from ncsim_core.scenario.making import make_scenario
from ncsim_core.trace.writer import TraceWriter
from ncsim_core.units import HORIZON_us

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


def scenario_of(size, edges, radio, floor=0.0, tasks=14):
    pairs = {(f"T{min(a, b)}", f"T{max(a, b)}"): None for a, b in edges if a != b}
    dag = dag_of(Form([f"T{number}" for number in range(tasks)], list(pairs)), dag_id="drawn")
    config = {
        "scheduler": "round_robin",
        "routing": "minimum_hop",
        "rf": radio,
        "interference": {"type": "csma_bianchi", "options": {"outage_floor_factor": floor}},
    }
    return make_scenario("drawn", paper_grid(size), [dag], config)


def trace_of(scenario, *, is_compiled):
    trace = io.StringIO()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(looping, "is_worth_compiling", lambda _: is_compiled)
        prepare(scenario, observers=[TraceWriter(trace)]).run()
    return trace.getvalue()


@needs_numba
@settings(max_examples=40, deadline=None)
@given(st.sampled_from([3, 5, 7]), EDGES, RADIOS, st.sampled_from([0.0, 0.01]))
def test_pure_and_compiled_runs_leave_the_same_trace_byte_by_byte(size, edges, radio, floor):
    scenario = scenario_of(size, edges, radio, floor)

    assert trace_of(scenario, is_compiled=True) == trace_of(scenario, is_compiled=False)


@needs_numba
def test_long_runs_under_the_radio_are_the_same_compiled():
    draw = random.Random(5)
    edges = [(draw.randrange(k), k) for k in range(1, 150) for _ in range(3)]
    scenario = scenario_of(6, edges, {}, floor=0.01, tasks=150)

    assert trace_of(scenario, is_compiled=True) == trace_of(scenario, is_compiled=False)


class Live(Observer):
    """Looks at the run while it goes on."""


def is_compiled(run):
    return looping.compiled_run_of(run.state, run.setup, HORIZON_us) is not None


@needs_numba
@pytest.mark.parametrize(("pure", "expected"), [("0", True), ("1", False)])
def test_runs_are_compiled_at_once_or_never_if_somebody_says_so(pure, expected, monkeypatch):
    monkeypatch.setenv("NCSIM_PURE", pure)

    assert is_compiled(prepare(scenario_of(3, [(0, 1)], {}))) is expected


@needs_numba
def test_runs_count_by_their_starts_and_finishes(monkeypatch):
    monkeypatch.setenv("NCSIM_PURE", "")
    run = prepare(scenario_of(3, [(0, 1)], {}))
    before_us = looping.PAYBACK.saved_us

    looping.is_worth_compiling(run.setup)

    added_us = 2 * len(run.setup.dependencies) * looping.SAVED_WITH_RADIO_us
    assert looping.PAYBACK.saved_us == before_us + added_us


@needs_numba
@pytest.mark.parametrize(
    ("changed", "observers"),
    [
        ({"interference": "csma_spatial"}, ()),
        (
            {
                "interference": {
                    "type": "csma_bianchi",
                    "options": {"hidden_model": "fixed_capture"},
                }
            },
            (),
        ),
        ({}, [Live()]),
    ],
)
def test_what_the_compiled_loop_does_not_know_runs_in_python(changed, observers, monkeypatch):
    monkeypatch.setattr(looping, "is_worth_compiling", lambda _: True)
    run = prepare(scenario_of(3, [(0, 1)], {}), observers=observers, **changed)

    assert not is_compiled(run)


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


def spatial_trace(**environment):
    command = [sys.executable, "-c", SPATIAL_TRACE]
    done = subprocess.run(command, env=os.environ | environment, capture_output=True, check=True)
    return done.stdout, done.stderr.decode()


@needs_numba
def test_csma_spatial_leaves_the_same_trace_with_arrays_and_with_compiled_loops():
    pure, said = spatial_trace(NCSIM_PURE="1")
    assert said == "numba=False"

    compiled, said = spatial_trace(NCSIM_PURE="0")
    assert said == "numba=True"

    assert pure == compiled
