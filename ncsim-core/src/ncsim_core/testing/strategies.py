"""Hypothesis strategies: small networks, DAGs, traffic, options and whole scenarios.

Small is on purpose: faults of plug-ins show on five nodes, and small examples can be read.
Draws include what is easily forgotten: no links, links without bandwidth, zero sizes, two nodes at
one place, two links between the same nodes, file orders that differ from id orders.
"""

from collections.abc import Sequence
from functools import cache

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from ncsim_core.contracts.queue_model import WaitingTask
from ncsim_core.network import LinkIndex, Network, Node, NodeId, Route
from ncsim_core.testing.drawing import (
    COSTS,
    SIZES_MB,
    DagCodes,
    Digits,
    dag_codes,
    dag_from,
    dags,
    drawn_codes,
    made,
    networks,
)
from ncsim_core.testing.option_strategies import options_for, radios, sections
from ncsim_core.testing.questions import Case
from ncsim_core.workflow import DAG, DagId, Dependency, Injection, Task, TaskId

__all__ = [
    "arrivals",
    "busy_runs",
    "dags",
    "instances",
    "networks",
    "options_for",
    "questions_about",
    "radios",
    "relayed_runs",
    "relayed_traffic",
    "runs",
    "sections",
    "traffic",
    "waiting_lines",
    "waiting_task",
]


def questions_about(drawn: SearchStrategy[Network]) -> SearchStrategy[Case]:
    """Return questions about a network alone."""
    return made(Case, drawn)


@cache
def instances(*, max_nodes: int = 4, max_tasks: int = 6) -> SearchStrategy[Case]:
    """Return a network and a DAG to place on it."""

    def case(network: Network, codes: DagCodes) -> Case:
        return Case(network, dag=dag_from(codes, [node.id for node in network.nodes]))

    return made(case, networks(max_nodes=max_nodes), dag_codes(max_tasks=max_tasks))


@cache
def traffic(*, max_nodes: int = 6, max_links: int = 10) -> SearchStrategy[Case]:
    """Return a network with links in use and a series of links to switch on and off."""

    def case(network: Network, active: list[int], toggles: list[int]) -> Case:
        count = len(network.links)
        if count == 0:
            return Case(network)
        return Case(
            network,
            active=tuple(dict.fromkeys(number % count for number in active)),
            toggles=tuple(number % count for number in toggles),
        )

    number = st.integers(0, 2 * max_links)
    return made(
        case,
        networks(max_nodes=max_nodes, max_links=max_links, is_bandwidth_optional=True),
        st.lists(number, max_size=max_links),
        st.lists(number, max_size=16),
    )


@cache
def relayed_traffic(*, max_routes: int = 6) -> SearchStrategy[Case]:
    """Return a network with routes in use, of one link to four, some of them twice."""

    def case(network: Network, codes: list[int]) -> Case:
        routes = [route for code in codes if (route := _walk(network, Digits(code)))]
        return Case(network, routes=tuple(sorted(routes)))

    drawn = networks(max_nodes=6, max_links=14, is_bandwidth_optional=True)
    return made(case, drawn, drawn_codes(1, max_routes))


@cache
def relayed_runs(*, max_transfers: int = 6) -> SearchStrategy[Case]:
    """Return runs in which several transfers are under way at once, over one link or more."""

    def case(network: Network, codes: list[int]) -> Case:
        dag = _transfers(network, [(Digits(code), Digits(code // 97)) for code in codes])
        return Case(network, injections=(Injection(0, dag),))

    return made(case, networks(max_nodes=6, max_links=14), drawn_codes(1, max_transfers))


def _walk(network: Network, digits: Digits) -> Route:
    """Return a route that visits no node twice, from any node."""
    visited = [digits.pick(range(len(network.nodes)))]
    route: list[LinkIndex] = []
    for _ in range(1 + digits.pick(range(4))):
        onward = [
            link
            for link in network.outgoing[visited[-1]]
            if network.targets[link] not in visited and network.links[link].bandwidth_MBps != 0
        ]
        if not onward:
            break
        route.append(digits.pick(onward))
        visited.append(network.targets[route[-1]])
    return tuple(route)


def _transfers(network: Network, choices: list[tuple[Digits, Digits]]) -> DAG:
    """Return a DAG of lone transfers between the ends of routes."""
    tasks, edges = [Task(TaskId("alone"), 0.0)], []
    for number, (digits, others) in enumerate(choices):
        route = _walk(network, digits)
        if not route:
            continue
        source, target = TaskId(f"a{number}"), TaskId(f"b{number}")
        cost = others.pick(COSTS)
        tasks.append(Task(source, cost, network.links[route[0]].source))
        tasks.append(Task(target, 0.0, network.links[route[-1]].target))
        edges.append(Dependency(source, target, others.pick(SIZES_MB)))
    return DAG(DagId("d"), tuple(tasks), tuple(edges))


@cache
def waiting_lines(*, max_length: int = 12) -> SearchStrategy[Case]:
    """Return pushes and pops of tasks that became ready one after another."""
    return made(_waiting_line, drawn_codes(0, max_length))


@cache
def runs(*, max_nodes: int = 4, max_tasks: int = 4) -> SearchStrategy[Case]:
    """Return a network and one or two DAGs that enter it, pinned to its nodes or not."""

    def case(network: Network, listed: list[tuple[int, DagCodes]]) -> Case:
        ids = [node.id for node in network.nodes]
        injections = (
            Injection(at_us, dag_from(codes, ids, f"d{number}"))
            for number, (at_us, codes) in enumerate(listed)
        )
        return Case(network, injections=tuple(injections))

    times = st.sampled_from((0, 250_000))
    listed = st.lists(st.tuples(times, dag_codes(max_tasks=max_tasks)), min_size=1, max_size=2)
    return made(case, networks(max_nodes=max_nodes), listed)


@cache
def busy_runs(*, max_transfers: int = 8) -> SearchStrategy[Case]:
    """Return runs in which many transfers are under way at once, each along one link."""

    def case(network: Network, codes: list[int]) -> Case:
        usable = [link for link in network.links if link.bandwidth_MBps]
        if not usable:
            lone = DAG(DagId("d"), (Task(TaskId("a0"), 0.0),), ())
            return Case(network, injections=(Injection(0, lone),))
        tasks: list[Task] = []
        edges: list[Dependency] = []
        for number, digits in enumerate(map(Digits, codes)):
            link, (source, target) = digits.pick(usable), (f"a{number}", f"b{number}")
            tasks.append(Task(TaskId(source), 0.0, link.source))
            tasks.append(Task(TaskId(target), digits.pick(COSTS), link.target))
            edges.append(Dependency(TaskId(source), TaskId(target), digits.pick(SIZES_MB)))
        return Case(network, injections=(Injection(0, DAG(DagId("d"), (*tasks,), (*edges,))),))

    return made(case, networks(max_links=14), drawn_codes(2, max_transfers))


def _waiting_line(codes: Sequence[int]) -> Case:
    waiting: list[WaitingTask | None] = []
    ready_us = 0
    for ticket, digits in enumerate(map(Digits, codes)):
        ready_us += digits.pick((0, 0, 5))
        waiting.append(waiting_task(ticket, digits.pick(COSTS), ready_us))
        if digits.pick((False, True)):
            waiting.append(None)
    return Case(Network((Node(NodeId("n0"), 100.0),), ()), waiting=tuple(waiting))


def waiting_task(ticket: int, compute_cost: float, ready_us: int) -> WaitingTask:
    """Return a task of one of two DAGs, told from the others by its ticket."""
    name = TaskId(f"T{ticket}")
    return WaitingTask(DagId(f"d{ticket % 2}"), name, compute_cost, ready_us, ticket)


@cache
def arrivals(*, max_dags: int = 3) -> SearchStrategy[Case]:
    """Return a network and the DAGs that a scenario lists, in no order of time."""

    def case(network: Network, listed: list[tuple[int, DagCodes]]) -> Case:
        injections = (
            Injection(at_us, dag_from(codes, (), f"d{number}"))
            for number, (at_us, codes) in enumerate(listed)
        )
        return Case(network, injections=tuple(injections))

    times = st.sampled_from((0, 1, 250_000, 1_000_000))
    listed = st.lists(st.tuples(times, dag_codes(max_tasks=3)), min_size=1, max_size=max_dags)
    return made(case, networks(max_nodes=3, max_links=2), listed)
