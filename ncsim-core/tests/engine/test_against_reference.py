"""The engine against an exact one that was written apart, on random scenarios, to the microsecond.

500 scenarios here; 10,000 with ``--hypothesis-profile=nightly``.
"""

from typing import NamedTuple

import pytest
from hypothesis import HealthCheck, Phase, assume, find, given, settings
from hypothesis import strategies as st
from hypothesis.errors import NoSuchExample
from ncsim_core.api import result_of
from ncsim_core.builtin.queue_models import FifoQueue
from ncsim_core.contracts.queue_model import QueueModel
from ncsim_core.contracts.scheduler import Scheduler
from ncsim_core.engine.setup import Limits
from ncsim_core.engine.simulation import Simulation
from ncsim_core.models import Models
from ncsim_core.network import Link, LinkId, Network, Node, NodeId
from ncsim_core.testing.builders import rated
from ncsim_core.testing.drawing import Digits, drawn_codes
from ncsim_core.testing.reference_engine import INJECT, ReferenceEngine
from ncsim_core.testing.toys import ToyRadio, ToyRelays, models
from ncsim_core.workflow import DAG, Dependency, Injection, PlacementPlan, Task

IS_NIGHTLY = settings.get_current_profile_name() == "nightly"

# Values that meet: 1 us, 1 s and 1/3 s come about in several ways, so that ends coincide.
CAPACITIES = (100.0, 100.0, 50.0, 300.0)
COSTS = (100.0, 50.0, 0.0, 1e-4, 200.0, 70.0)
SIZES_MB = (10.0, 5.0, 0.0, 1e-5, 2.5, 7.0, 20.0)
BANDWIDTHS_MBps = (10.0, 10.0, 5.0, 3.0, 20.0)
LATENCIES_s = (0.0, 0.0, 0.0, 1e-6, 0.25, 0.5)
TIMES_us = (0, 0, 1, 250_000, 1_000_000, 1_500_000)
LIMITS = st.sampled_from(
    (*[Limits()] * 13, Limits(max_events=40), Limits(max_time_us=0), Limits(max_time_us=1_100_000))
)


class Scenario(NamedTuple):
    network: Network
    models: Models
    limits: Limits


class EmptiestNode(Scheduler):
    """Asks for everything that a snapshot tells of a run under way."""

    def schedule(self, dag, snapshot):
        busy = list(snapshot.queue_depths)
        for transfer in snapshot.active_transfers:
            busy[transfer.target] += 1
        plan = {}
        for task in dag.tasks:
            node = busy.index(min(busy))
            busy[node] += 1
            plan[task.id] = snapshot.network.nodes[node].id
        return PlacementPlan(plan)


class LastInFirstOut(QueueModel):
    def __init__(self, context):
        self._tasks = []

    def push(self, task):
        self._tasks.append(task)

    def pop(self):
        return self._tasks.pop()

    def __len__(self):
        return len(self._tasks)


def network_from(node_codes, link_codes):
    """Return a tree, mostly both ways and mostly usable, and some links more."""
    nodes = [
        Node(NodeId(f"n{k}"), Digits(code).pick(CAPACITIES)) for k, code in enumerate(node_codes)
    ]
    links = []

    def connect(digits, source, target):
        bandwidth = 0.0 if digits.pick(range(12)) == 11 else digits.pick(BANDWIDTHS_MBps)
        name, ends = f"l{len(links)}", (nodes[source].id, nodes[target].id)
        links.append(Link(LinkId(name), *ends, bandwidth, digits.pick(LATENCIES_s)))

    for number, digits in enumerate(map(Digits, node_codes[1:]), 1):
        other = digits.pick(range(number))
        connect(digits, other, number)
        if digits.pick(range(8)) != 7:
            connect(digits, number, other)
    pairs = [(a, b) for a in range(len(nodes)) for b in range(len(nodes)) if a != b]
    for digits in map(Digits, link_codes):
        connect(digits, *digits.pick(pairs))
    return rated(Network(tuple(nodes), tuple(links)))


def radio_from(codes, link_count):
    """Return a radio on which links slow, disturb and stall each other, some one way only."""
    neighbours = {link: set() for link in range(link_count)}
    hidden = {link: set() for link in range(link_count)}
    stop_at = 99
    for digits in map(Digits, codes):
        a, b = digits.pick(range(link_count)), digits.pick(range(link_count))
        table = digits.pick((neighbours, neighbours, hidden))
        table[a].add(b)
        if digits.pick((True, True, False)):
            table[b].add(a)
        stop_at = digits.pick((99, 99, 3, 2, 1))
    return ToyRadio(neighbours, hidden, stop_at=stop_at)


def injection_from(number, codes, ids):
    time_code, task_codes, edge_codes = codes
    pins = Digits(time_code // len(TIMES_us)).pick(([*ids], [*ids], [*ids, None], [None]))
    drawn = [Digits(code) for code in task_codes]
    names = [f"t{k}" for k in range(len(drawn))]  # "t10" comes before "t2"
    tasks = tuple(
        Task(name, digits.pick(COSTS), digits.pick(pins))
        for name, digits in zip(names, drawn, strict=True)
    )
    sizes_MB = {}
    for digits in map(Digits, edge_codes if len(names) > 1 else ()):
        target = digits.pick(range(1, len(names)))
        source = max(0, target - 1 - digits.pick(range(6)))
        sizes_MB[names[source], names[target]] = digits.pick(SIZES_MB)
    edges = tuple(Dependency(*ends, size_MB) for ends, size_MB in sizes_MB.items())
    return Injection(Digits(time_code).pick(TIMES_us), DAG(f"d{number}", tasks, edges))


@st.composite
def dag_codes(draw):
    small = draw(st.booleans())
    tasks = draw(drawn_codes(1, 5) if small else drawn_codes(6, 30))
    return draw(st.integers(0, 2**16)), tasks, draw(drawn_codes(len(tasks) // 2, 2 * len(tasks)))


@st.composite
def scenarios(draw):
    """Return 2 to 12 nodes, up to four DAGs of up to 30 tasks, and a radio between the links."""
    network = network_from(draw(drawn_codes(2, 4) | drawn_codes(5, 12)), draw(drawn_codes(0, 12)))
    ids = [node.id for node in network.nodes]
    listed = draw(st.lists(dag_codes(), min_size=1, max_size=4))
    injections = [injection_from(number, codes, ids) for number, codes in enumerate(listed)]
    if draw(st.integers(0, 7)) == 7:
        radio = ToyRelays(network, stop_at=draw(st.sampled_from((99, 99, 2, 3))))
    else:
        radio = radio_from(draw(drawn_codes(0, 6) | drawn_codes(10, 40)), len(network.links))
    scheduler = draw(st.sampled_from((None, None, EmptiestNode())))
    queue = draw(st.sampled_from((FifoQueue, FifoQueue, FifoQueue, LastInFirstOut)))
    who = models(network, injections, scheduler=scheduler, interference=radio, queue=queue)
    return Scenario(network, who, draw(LIMITS))


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
@given(scenarios())
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
    search = settings(max_examples=500, database=None, derandomize=True, phases=[Phase.generate])
    try:
        find(scenarios(), lambda scenario: differs(scenario, wrong), settings=search)
    except NoSuchExample:
        pytest.fail(f"no scenario tells {wrong.__name__} from the engine")
