"""Local refresh equals global refresh, and bytes are neither lost nor invented."""

import math
import re
from dataclasses import replace
from itertools import pairwise

from hypothesis import given, settings
from ncsim_core.engine.outcome import RunStatus
from ncsim_core.engine.setup import Reach
from ncsim_core.testing.whole_runs import run_cases


def picture(simulation):
    """Return everything that both kinds of refresh must agree on, brought up to this instant."""
    state = simulation.state
    transfers = {}
    served_MB = state.served_MB()
    for number, transfer in sorted(state.transfers.items()):
        due_MB = transfer.rate_MBps * (state.now_us - transfer.credited_us) / 1e6
        due_MB = min(due_MB, transfer.remaining_MB)
        for link in transfer.route:
            served_MB[link] += due_MB
        transfers[number] = (transfer.rate_MBps, transfer.remaining_MB - due_MB)
    times = [(task.ready_us, task.started_us, task.ended_us) for task in state.tasks]
    return state.now_us, times, transfers, served_MB


def close(one, other):
    return math.isclose(one, other, rel_tol=1e-9, abs_tol=1e-9)


def assert_same(local, globally):
    now_us, times, transfers, served_MB = picture(local)
    other_now_us, other_times, other_transfers, other_served_MB = picture(globally)
    assert now_us == other_now_us
    assert times == other_times
    assert transfers.keys() == other_transfers.keys()
    for number, (rate_MBps, left_MB) in transfers.items():
        other_rate_MBps, other_left_MB = other_transfers[number]
        assert rate_MBps == other_rate_MBps
        assert close(left_MB, other_left_MB)
    assert all(map(close, served_MB, other_served_MB))


@settings(max_examples=200, deadline=None)
@given(run_cases())
def test_local_refresh_equals_global_refresh_after_every_event(case):
    assert_local_goes_like_global(case)


@settings(max_examples=150, deadline=None)
@given(run_cases(decides_routes=True))
def test_moving_only_changed_rates_of_routes_equals_moving_all(case):
    assert_local_goes_like_global(case, is_settled=starts_no_more)


def starts_no_more(simulation):
    """Return whether no transfer starts next at this instant, for which rates would wait."""
    return simulation.state.queue.next_start(simulation.state.now_us) is None


def assert_local_goes_like_global(case, *, is_settled=lambda _: True):
    local, globally = (case.simulation(reach=reach) for reach in Reach)

    while local.outcome is None:
        event, other = local.step(), globally.step()
        assert event == other
        if is_settled(local):
            assert_same(local, globally)
    assert_same_end(local.outcome, globally.outcome)


def assert_same_end(one, other):
    """Compare two ends; the MB left are compared as numbers by ``assert_same``."""
    one, other = (
        replace(each, detail=re.sub(r"[0-9.e-]+ MB left", "MB left", each.detail))
        for each in (one, other)
    )
    assert one == other


@settings(max_examples=60, deadline=None)
@given(run_cases() | run_cases(decides_routes=True))
def test_completed_runs_serve_every_byte_on_every_hop_once(case):
    simulation = case.simulation()
    outcome = simulation.run()

    if outcome.status is RunStatus.COMPLETED:
        served_MB = sum(simulation.state.served_MB())
        asked_MB_hops = sum(
            each.entry.size_MB * len(each.route) for each in simulation.state.transfers.values()
        )
        assert math.isclose(served_MB, asked_MB_hops, rel_tol=1e-9, abs_tol=1e-9)
        assert all(each.remaining_MB == 0 for each in simulation.state.transfers.values())


@settings(max_examples=60, deadline=None)
@given(run_cases())
def test_a_node_never_runs_two_tasks(case):
    simulation = case.simulation()
    simulation.run()

    by_node = {}
    for task in simulation.state.tasks:
        if task.started_us is not None and task.ended_us is not None:
            by_node.setdefault(task.node, []).append((task.started_us, task.ended_us))
    for spans in by_node.values():
        spans.sort()
        assert all(a_end <= b_start for (_, a_end), (b_start, _) in pairwise(spans))


@settings(max_examples=60, deadline=None)
@given(run_cases())
def test_makespan_is_at_least_the_critical_path_at_full_speed(case):
    simulation = case.simulation()
    outcome = simulation.run()

    if outcome.status is RunStatus.COMPLETED:
        slack_us = 2 * len(simulation.state.tasks)  # each task and transfer may round by one
        fastest_us = critical_path_us(simulation, case.injections, case.network)
        assert outcome.makespan_us + slack_us >= fastest_us


def critical_path_us(simulation, injections, network):
    state, setup = simulation.state, simulation.setup
    finish_us = []
    for task in state.tasks:
        start_us = injections[task.entry.dag].at_us
        for entry in setup.dependencies:
            if entry.target == task.entry.number:
                start_us = max(start_us, finish_us[entry.source] + alone_us(entry, setup, state))
        cost = task.entry.task.compute_cost
        finish_us.append(start_us + cost / network.nodes[task.node].compute_capacity * 1e6)
    return max(finish_us, default=0)


def alone_us(entry, setup, state):
    source, target = state.tasks[entry.source].node, state.tasks[entry.target].node
    if source == target:
        return 0.0
    route = setup.routes.route(source, target)
    rate_MBps = setup.network.route_bottleneck_MBps(route)
    return (setup.network.route_latency_s(route) + entry.size_MB / rate_MBps) * 1e6
