"""The engine under the real radio model, on random geometries.

Local refresh equals global refresh, and both equal an exact engine that was written apart.
"""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from ncsim_core.api import result_of
from ncsim_core.context import BuildContext, ModelCache
from ncsim_core.engine.setup import Reach
from ncsim_core.engine.simulation import Simulation
from ncsim_core.network import Link, Network, Node, Position
from ncsim_core.registry import get_registry
from ncsim_core.testing.reference_engine import ReferenceEngine
from ncsim_core.testing.toys import models
from ncsim_core.workflow import DAG, Dependency, Injection, Task

IS_NIGHTLY = settings.get_current_profile_name() == "nightly"
PLACES_m = st.integers(0, 160)
RADIOS = st.fixed_dictionaries(
    {
        "rts_cts": st.booleans(),
        "capture_margin_dB": st.sampled_from([0.0, 5.0]),
        "shadow_fading_sigma": st.sampled_from([0.0, 6.0]),
    }
)


@st.composite
def instances(draw):
    count = draw(st.integers(2, 7))
    nodes = tuple(
        Node(f"n{k}", 100.0, Position(float(draw(PLACES_m)), float(draw(PLACES_m))))
        for k in range(count)
    )
    pairs = [(a, b) for a in range(count) for b in range(count) if a != b]
    chosen = draw(st.lists(st.sampled_from(pairs), min_size=1, max_size=16, unique=True))
    links = tuple(Link(f"l{a}_{b}", f"n{a}", f"n{b}") for a, b in chosen)
    return Network(nodes, links), draw(dags(chosen)), draw(RADIOS)


@st.composite
def dags(draw, pairs):
    """Return transfers between linked nodes, some one after the other."""
    ends = draw(st.lists(st.sampled_from(pairs), min_size=1, max_size=8))
    tasks, dependencies = [], []
    for k, (a, b) in enumerate(ends):
        cost = draw(st.sampled_from([0.0, 50.0, 100.0]))
        tasks += [Task(f"S{k}", cost, f"n{a}"), Task(f"R{k}", cost, f"n{b}")]
        size_MB = draw(st.sampled_from([0.5, 1.0, 3.0]))
        dependencies.append(Dependency(f"S{k}", f"R{k}", size_MB))
    return DAG("d", tuple(tasks), tuple(dependencies))


def simulation_of(instance, reach):
    network, dag, rf = instance
    injections = (Injection(0, dag),)
    registry, sections, cache = get_registry(), {"rf": rf}, ModelCache()
    bare = BuildContext(network, 42, sections, injections, cache)
    link_model, _ = registry.build("link_model", "wifi", {}, bare)
    rated = network.with_rates(link_model.rate_links(network))
    context = BuildContext(rated, 42, sections, injections, cache)
    interference, _ = registry.build("interference_model", "csma_bianchi", {}, context)
    return Simulation(rated, models(rated, injections, interference=interference), reach=reach)


def picture(simulation):
    state = simulation.state
    flows = {}
    for number, transfer in sorted(state.transfers.items()):
        due_MB = transfer.rate_MBps * (state.now_us - transfer.credited_us) / 1e6
        flows[number] = (transfer.rate_MBps, max(0.0, transfer.remaining_MB - due_MB))
    times = [(task.ready_us, task.started_us, task.ended_us) for task in state.tasks]
    return state.now_us, times, flows


@settings(max_examples=2000 if IS_NIGHTLY else 60, deadline=None)
@given(instances())
def test_the_engine_agrees_with_the_exact_reference_to_the_microsecond(instance):
    simulation = simulation_of(instance, Reach.LOCAL)
    reference = ReferenceEngine(simulation.setup.network, simulation.setup.models).run()
    assume(not reference.is_too_close)

    outcome = simulation.run()

    ends = [(outcome.status, outcome.events, outcome.ended_us, outcome.makespan_us)]
    ends += [(task.ready_us, task.started_us, task.ended_us) for task in simulation.state.tasks]
    expected = [(reference.status, reference.events, reference.now_us, reference.makespan_us)]
    expected += [(job.ready_us, job.started_us, job.ended_us) for job in reference.jobs]
    assert ends == expected
    served_MB = [link.served_MB for link in result_of(simulation).links]
    assert served_MB == pytest.approx([float(each) for each in reference.served_MB], abs=1e-9)


@settings(max_examples=80, deadline=None)
@given(instances())
def test_local_refresh_equals_global_refresh_after_every_event(instance):
    local, globally = (simulation_of(instance, reach) for reach in Reach)

    while local.outcome is None:
        local.step()
        globally.step()
        now_us, times, flows = picture(local)
        other_now_us, other_times, other_flows = picture(globally)
        assert (now_us, times) == (other_now_us, other_times)
        assert flows.keys() == other_flows.keys()
        for number, (rate_MBps, left_MB) in flows.items():
            assert rate_MBps == other_flows[number][0]
            assert math.isclose(left_MB, other_flows[number][1], rel_tol=1e-9, abs_tol=1e-9)
    assert local.outcome == globally.outcome
