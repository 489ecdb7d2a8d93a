"""Numbers at their extremes: twelve orders of magnitude, long times, a thousand contenders."""

from collections import defaultdict
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_core.api import result_of
from ncsim_core.engine.observer import Observer
from ncsim_core.engine.setup import Limits
from ncsim_core.engine.simulation import Simulation
from ncsim_core.network import Link, LinkRates, Network, Node
from ncsim_core.testing.builders import inject, rated
from ncsim_core.testing.toys import ToyRadio, models
from ncsim_core.units import HORIZON_us
from ncsim_core.workflow import DAG, Dependency, Injection, Task

ONE_BYTE_MB, ONE_TERABYTE_MB = 1e-6, 1e6
BANDWIDTHS_MBps = [10.0**power for power in range(-6, 7)]
SIZES_MB = [10.0**power for power in range(-6, 7)]


def star_of(bandwidths_MBps):
    """Return a hub with one link into it for each bandwidth."""
    nodes = [Node("hub", 1.0), *(Node(f"n{k}", 1.0) for k in range(len(bandwidths_MBps)))]
    links = [Link(f"l{k}", f"n{k}", "hub", each) for k, each in enumerate(bandwidths_MBps)]
    return rated(Network(tuple(nodes), tuple(links)))


def sending(numbered, at_us=0, dag_id="d"):
    """Return transfers to the hub, given as (node, size), that all begin at once."""
    tasks, dependencies = [], []
    for number, (node, size_MB) in enumerate(numbered):
        tasks += [Task(f"s{number}", 0.0, f"n{node}"), Task(f"r{number}", 0.0, "hub")]
        dependencies.append(Dependency(f"s{number}", f"r{number}", size_MB))
    return Injection(at_us, DAG(dag_id, tuple(tasks), tuple(dependencies)))


class Meter(Observer):
    """Adds up what the rates that are told amount to."""

    def __init__(self):
        self.rate_MBps = defaultdict(float)
        self.since_us = {}
        self.served_MB = defaultdict(float)
        self.at_end_MB = {}

    def rates_assigned(self, at_us, cause, changes):
        for change in changes:
            self._count(change.transfer, at_us)
            self.rate_MBps[change.transfer] = change.rate_MBps

    def transfer_ended(self, at_us, transfer):
        self._count(transfer, at_us)
        self.at_end_MB[transfer] = self.served_MB[transfer]

    def _count(self, transfer, at_us):
        elapsed_us = at_us - self.since_us.get(transfer, at_us)
        self.served_MB[transfer] += self.rate_MBps[transfer] * elapsed_us / 1_000_000
        self.since_us[transfer] = at_us


def run(network, *injections, interference=None):
    meter = Meter()
    who = models(network, injections, interference=interference)
    simulation = Simulation(network, who, observers=[meter])
    assert simulation.run().status == "completed", simulation.outcome.detail
    return simulation, meter


def expect_all_bytes(simulation, meter):
    """Check that each transfer had its bytes when it ended, and links count what was sent."""
    sent_MB = defaultdict(float)
    for number, transfer in simulation.state.transfers.items():
        size_MB = transfer.entry.size_MB
        assert transfer.remaining_MB == 0
        # a completion may be early by 1e-5 us of service, never by more
        slack_MB = meter.rate_MBps[number] * 1.1e-11
        assert meter.at_end_MB[number] >= size_MB * (1 - 1e-6) - slack_MB
        for link in transfer.route:
            sent_MB[link] += size_MB
    links = result_of(simulation).links
    for link, expected_MB in sent_MB.items():
        assert links[link].served_MB == pytest.approx(expected_MB, rel=1e-6)


@pytest.mark.parametrize("bandwidth_MBps", BANDWIDTHS_MBps)
@pytest.mark.parametrize("size_MB", [ONE_BYTE_MB, 1.0, ONE_TERABYTE_MB])
def test_a_transfer_alone_takes_its_size_over_its_rate(bandwidth_MBps, size_MB):
    exact_us = Fraction(size_MB) / Fraction(bandwidth_MBps) * 1_000_000
    if exact_us > HORIZON_us:
        pytest.skip("longer than any run may be")

    simulation, meter = run(star_of([bandwidth_MBps]), sending([(0, size_MB)]))

    ended_us = simulation.state.transfers[0].ended_us
    assert exact_us * (1 - Fraction(1, 10**12)) - 1 <= ended_us
    assert ended_us <= exact_us * (1 + Fraction(1, 10**12)) + 1
    expect_all_bytes(simulation, meter)


@settings(max_examples=60)
@given(
    st.lists(
        st.tuples(
            st.integers(0, 3), st.sampled_from(SIZES_MB[:10]), st.sampled_from([0, 1, 10**6])
        ),
        min_size=1,
        max_size=12,
    ),
    st.lists(st.sampled_from(BANDWIDTHS_MBps[3:]), min_size=4, max_size=4),
)
def test_no_bytes_are_lost_or_invented_among_very_different_rates(sends, bandwidths_MBps):
    network = star_of(bandwidths_MBps)
    injections = [
        sending([(node, size_MB)], at_us, f"d{number}")
        for number, (node, size_MB, at_us) in enumerate(sorted(sends, key=lambda each: each[2]))
    ]
    everyone = {link: set(range(4)) - {link} for link in range(4)}

    simulation, meter = run(network, *injections, interference=ToyRadio(everyone))

    expect_all_bytes(simulation, meter)


def test_a_thousand_contenders_lose_no_bytes():
    injections = [
        sending([(0, 1.0 + number % 7)], 13 * number, f"d{number}") for number in range(1000)
    ]

    simulation, meter = run(star_of([10.0]), *injections)

    expect_all_bytes(simulation, meter)
    total_MB = sum(1.0 + number % 7 for number in range(1000))
    assert simulation.outcome.makespan_us == pytest.approx(total_MB / 10.0 * 1e6, rel=1e-6)


def test_a_run_may_begin_after_a_billion_seconds():
    simulation, meter = run(star_of([3.0]), sending([(0, 1.0)], 10**15))

    assert simulation.outcome.makespan_us == 10**15 + 333_334
    expect_all_bytes(simulation, meter)


ENDLESS = [
    ({"cost": 1e100}, "task dag: T0, whose cost over capacity is too large"),
    ({"size_MB": 1e100}, "transfer dag: T0 -> T1, whose size over rate or latency is too large"),
    ({"latency_s": 1e100}, "transfer dag: T0 -> T1, whose size over rate or latency is too large"),
]


@pytest.mark.parametrize(("amounts", "blame"), ENDLESS, ids=lambda each: str(each)[:12])
def test_what_would_end_after_285_years_fails_the_run_and_is_named(amounts, blame):
    given = {"cost": 1.0, "size_MB": 1.0, "latency_s": 0.0} | amounts
    network = Network(
        (Node("a", 1.0), Node("b", 1.0)),
        (Link("ab", "a", "b"),),
        LinkRates((1.0,), (given["latency_s"],)),
    )
    tasks = (Task("T0", given["cost"], "a"), Task("T1", 0.0, "b"))
    dag = DAG("dag", tasks, (Dependency("T0", "T1", given["size_MB"]),))

    outcome = Simulation(network, models(network, [inject(dag)])).run()

    assert outcome.status == "failed"
    assert outcome.makespan_us is None
    assert outcome.detail.endswith(blame)


def test_a_limit_of_time_comes_before_the_end_of_time():
    network = star_of([1.0])
    limits = Limits(max_time_us=1000)

    outcome = Simulation(network, models(network, [sending([(0, 1e100)])]), limits).run()

    assert outcome.status == "limit_reached"
