"""The engine against an exact one that was written apart, on random scenarios, to the microsecond.

500 scenarios here; 10,000 with ``--hypothesis-profile=nightly``.
"""

from typing import NamedTuple

import pytest
from hypothesis import HealthCheck, Phase, assume, find, given, settings
from hypothesis.errors import NoSuchExample
from ncsim_core.api import result_of
from ncsim_core.engine.simulation import Simulation
from ncsim_core.testing.engine_cases import engine_cases
from ncsim_core.testing.reference_engine import INJECT, ReferenceEngine

IS_NIGHTLY = settings.get_current_profile_name() == "nightly"


class Picture(NamedTuple):
    """What must agree to the microsecond."""

    status: str
    ended_us: int
    makespan_us: int | None
    events: int
    tasks: list
    transfers: dict


def microseconds(*times_s):
    return tuple(None if time_s is None else round(time_s * 1e6) for time_s in times_s)


def engine_result(scenario):
    simulation = Simulation(scenario.network, scenario.models, scenario.limits)
    outcome = simulation.run()
    return outcome, result_of(simulation)


def picture_of_engine(outcome, result, network):
    tasks = [
        (t.node and network.node_index[t.node], *microseconds(t.ready_s, t.started_s, t.ended_s))
        for t in result.tasks
    ]
    transfers = {
        (t.dag, t.source_task, t.target_task): (
            tuple(network.link_index[link] for link in t.route),
            *microseconds(t.created_s, t.started_s, t.ended_s),
        )
        for t in result.transfers
    }
    status = str(outcome.status)
    return Picture(status, outcome.ended_us, outcome.makespan_us, outcome.events, tasks, transfers)


def picture_of_reference(run):
    tasks = [
        (None if job.node < 0 else job.node, job.ready_us, job.started_us, job.ended_us)
        for job in run.jobs
    ]
    transfers = {f.key: (f.route, f.created_us, f.started_us, f.ended_us) for f in run.flows}
    return Picture(run.status, run.now_us, run.makespan_us, run.events, tasks, transfers)


def reference_run(scenario, reference=ReferenceEngine):
    limits = scenario.limits
    engine = reference(scenario.network, scenario.models, limits.max_events, limits.max_time_us)
    return engine.run()


@settings(max_examples=10_000 if IS_NIGHTLY else 500, suppress_health_check=[*HealthCheck])
@given(engine_cases())
def test_the_engine_agrees_with_the_exact_reference_to_the_microsecond(scenario):
    reference = reference_run(scenario)
    assume(not reference.is_too_close)

    outcome, result = engine_result(scenario)

    expected = picture_of_reference(reference)
    assert picture_of_engine(outcome, result, scenario.network) == expected
    if expected.status in ("completed", "blocked_wireless"):
        left_MB = {flow.key: float(flow.left_MB) for flow in reference.flows}
        for transfer in result.transfers:
            key = transfer.dag, transfer.source_task, transfer.target_task
            assert transfer.remaining_MB == pytest.approx(left_MB[key], rel=1e-9, abs=1e-9)
        served_MB = [float(each) for each in reference.served_MB]
        assert [link.served_MB for link in result.links] == pytest.approx(served_MB, abs=1e-9)


# Each rule of the reference is pinned by some scenario: with the rule wrong, the two differ.


class NearestCompletion(ReferenceEngine):
    def rounded_up(self, exact_us):
        return self.rounded(exact_us)


class CompletionWithoutSlack(ReferenceEngine):
    def rounded_up(self, exact_us):
        return -(-exact_us.numerator // exact_us.denominator)


class DurationRoundedUp(ReferenceEngine):
    def rounded(self, exact_us):
        return -(-exact_us.numerator // exact_us.denominator)


class CreditAtTheNewRate(ReferenceEngine):
    """Assign before crediting: what was served since the last event counts at the new rate."""

    _late_us = 0

    def serve_until(self, at_us):
        self.now_us, self._late_us = at_us, self._late_us + at_us - self.now_us

    def rates(self):
        rates = super().rates()
        for flow, rate_MBps in rates.items():
            self.serve(flow, min(flow.left_MB, rate_MBps * self._late_us / 1_000_000))
        self._late_us = 0
        return rates


class SecondTransferEndFirst(ReferenceEngine):
    """Completions of one microsecond in reverse text order."""

    def completions(self):
        turned = (tuple(-ord(c) for part in d.tie for c in part) for d in super().completions())
        return [d._replace(tie=tie) for d, tie in zip(super().completions(), turned, strict=True)]


class LateRelease(ReferenceEngine):
    """The data is handed over before the route is free, rates move at the next event only."""

    def finish(self, flow):
        rates = self._rates
        super().finish(flow)
        self._rates = {other: rate for other, rate in rates.items() if other is not flow}


class LatencyOccupiesTheRoute(ReferenceEngine):
    def active_flows(self):
        return [flow for flow in self.flows if flow.ended_us is None and flow.size_MB]


class ResultsBeforeTheQueue(ReferenceEngine):
    """A finished task passes its results on before its node is free."""

    def end_task(self, job):
        self.hand_over, hand_over = lambda _: None, self.hand_over
        super().end_task(job)
        self.hand_over = hand_over
        self._later(self.now_us, 3, lambda: hand_over(job.node))


class NodeNotReserved(ReferenceEngine):
    def claim(self, job):
        super().claim(job)
        self.claims[job.node] = None


class StalledTransfersLeaveTheChannel(ReferenceEngine):
    """A transfer at zero rate stops counting as active."""

    def active_flows(self):
        flows = super().active_flows()
        stalled = [flow for flow in flows if self._rates.get(flow) == 0]
        return [flow for flow in flows if flow not in stalled]


class ZeroBytesWaitForARate(ReferenceEngine):
    """A transfer without bytes is not over while interference stops its route."""

    def active_flows(self):
        return [f for f in self.flows if f.started_us is not None and f.ended_us is None]

    def start(self, flow):
        flow.started_us = self.now_us
        self._rates = self.rates()

    def completions(self):
        return [d for d in super().completions() if self._rate_of(d.tie) > 0]

    def _rate_of(self, key):
        return next(rate for flow, rate in self._rates.items() if flow.key == key)


class InjectionsLast(ReferenceEngine):
    """What ends at one instant comes before what is injected then."""

    def _later(self, at_us, priority, action, key=None):
        super()._later(at_us, 9 if priority == INJECT else priority, action, key)


class FirstHopDecides(ReferenceEngine):
    """The rate of a route is that of its first link."""

    def rates(self):
        routes = [(flow, flow.route) for flow in self.flows]
        for flow, route in routes:
            flow.route = route[:1]
        rates = super().rates()
        for flow, route in routes:
            flow.route = route
        return rates


WRONG = [
    NearestCompletion,
    CompletionWithoutSlack,
    DurationRoundedUp,
    CreditAtTheNewRate,
    SecondTransferEndFirst,
    LateRelease,
    LatencyOccupiesTheRoute,
    ResultsBeforeTheQueue,
    NodeNotReserved,
    StalledTransfersLeaveTheChannel,
    ZeroBytesWaitForARate,
    InjectionsLast,
    FirstHopDecides,
]


def differs(scenario, wrong):
    reference = reference_run(scenario, wrong)
    outcome, result = engine_result(scenario)
    engine = picture_of_engine(outcome, result, scenario.network)
    return engine != picture_of_reference(reference)


@pytest.mark.parametrize("wrong", WRONG, ids=lambda wrong: wrong.__name__)
def test_scenarios_tell_a_wrong_rule(wrong):
    search = settings(max_examples=5000, database=None, derandomize=True, phases=[Phase.generate])
    try:
        find(engine_cases(), lambda scenario: differs(scenario, wrong), settings=search)
    except NoSuchExample:
        pytest.fail(f"no scenario tells {wrong.__name__} from the engine")
