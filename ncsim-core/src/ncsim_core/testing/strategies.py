"""Hypothesis strategies: small networks, DAGs, traffic, options and whole scenarios.

Small is on purpose: faults of plug-ins show on five nodes, and small examples can be read.
Draws include what is easily forgotten: no links, links without bandwidth, zero sizes, two nodes at
one place, two links between the same nodes, file orders that differ from id orders.
"""

import random
from collections.abc import Callable, Sequence
from functools import cache
from typing import TypeAlias, TypeVar

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from ncsim_core.contracts.queue_model import WaitingTask
from ncsim_core.network import Link, LinkId, Medium, Network, Node, NodeId, Position
from ncsim_core.testing.option_strategies import options_for, radios, sections
from ncsim_core.testing.questions import Case
from ncsim_core.workflow import DAG, DagId, Dependency, Injection, Task, TaskId

__all__ = [
    "arrivals",
    "dags",
    "instances",
    "networks",
    "options_for",
    "questions_about",
    "radios",
    "sections",
    "traffic",
    "waiting_lines",
    "waiting_task",
]

T = TypeVar("T")

CAPACITIES = (50.0, 80.0, 100.0, 250.0)
BANDWIDTHS_MBps = (10.0, 2.5, 1.0, 40.0, 0.0)
MEDIA: tuple[Medium, ...] = ("wireless", "wireless", "wireless", "wired")
COORDINATES_m = tuple(25.0 * k for k in range(9))
LATENCIES_s = (0.0, 0.0, 0.01, 0.25)
COSTS = (100.0, 1.0, 500.0, 0.0)
SIZES_MB = (10.0, 1.0, 12.5, 0.0)


class _Digits:
    """Takes choices out of one whole number, which costs one draw instead of many.

    0 means the first choice everywhere, so that shrinking leads to the plainest object.
    """

    def __init__(self, number: int) -> None:
        self._rest = number

    def pick(self, choices: Sequence[T]) -> T:
        """Return one of the choices."""
        self._rest, index = divmod(self._rest, len(choices))
        return choices[index]


def _codes(min_size: int, max_size: int) -> SearchStrategy[list[int]]:
    return st.lists(st.integers(0, 2**24 - 1), min_size=min_size, max_size=max_size)


@st.composite
def _made(draw: DrawFn, make: Callable[..., T], *parts: SearchStrategy[object]) -> T:
    """Return ``make`` of what is drawn; unlike ``builds``, failures show the object itself."""
    return make(*(draw(part) for part in parts))


_ORDERS = st.integers(0, 3)
"""Seeds of file orders; 0 is the order of the ids."""


def _ordered(items: Sequence[T], order: int) -> list[T]:
    listed = list(items)
    if order:
        random.Random(order).shuffle(listed)
    return listed


@cache
def networks(
    *, max_nodes: int = 5, max_links: int = 10, is_bandwidth_optional: bool = False
) -> SearchStrategy[Network]:
    """Return networks without decided rates.

    Half of them are as sparse as it comes, half have links enough for routes to compete.

    Args:
        max_nodes: At least 1.
        max_links: Parallel links count.
        is_bandwidth_optional: Half of the networks leave all bandwidths to the link model.
    """
    is_bare = st.booleans() if is_bandwidth_optional else st.just(value=False)

    def of(min_nodes: int, min_links: int) -> SearchStrategy[Network]:
        nodes, links = _codes(min_nodes, max_nodes), _codes(min_links, max_links)
        return _made(_network, nodes, links, _ORDERS, is_bare)

    return of(1, 0) | of(min(3, max_nodes), 3 * max_links // 4)


def _network(
    node_codes: Sequence[int],
    link_codes: Sequence[int],
    order: int,
    is_bare: bool,  # noqa: FBT001 - drawn in order
) -> Network:
    nodes = [_node(number, _Digits(code)) for number, code in enumerate(node_codes)]
    pairs = [(a.id, b.id) for a in nodes for b in nodes if a is not b]
    links = [
        _link(f"l{number}", pairs, _Digits(code), is_bare=is_bare)
        for number, code in enumerate(link_codes if pairs else ())
    ]
    return Network(tuple(_ordered(nodes, order)), tuple(_ordered(links, order)))


def _node(number: int, digits: _Digits) -> Node:
    x_m, y_m = digits.pick(COORDINATES_m), digits.pick(COORDINATES_m)
    return Node(NodeId(f"n{number}"), digits.pick(CAPACITIES), Position(x_m, y_m))


def _link(
    name: str, pairs: Sequence[tuple[NodeId, NodeId]], digits: _Digits, *, is_bare: bool
) -> Link:
    return Link(
        LinkId(name),
        *digits.pick(pairs),
        bandwidth_MBps=None if is_bare else digits.pick(BANDWIDTHS_MBps),
        latency_s=digits.pick(LATENCIES_s),
        medium="wireless" if is_bare else digits.pick(MEDIA),
    )


@cache
def dags(
    *, max_tasks: int = 6, pin_to: tuple[NodeId, ...] = (), dag_id: str = "dag"
) -> SearchStrategy[DAG]:
    """Return DAGs; with ``pin_to``, none, some or all of their tasks are pinned to these nodes."""
    return _made(lambda codes: dag_from(codes, pin_to, dag_id), dag_codes(max_tasks=max_tasks))


DagCodes: TypeAlias = tuple[list[int], list[int], int, str]


@cache
def dag_codes(*, max_tasks: int) -> SearchStrategy[DagCodes]:
    """Return what ``dag_from`` makes a DAG of, once the nodes to pin to are known."""
    pinning = st.sampled_from(("none", "some", "all"))
    return st.tuples(_codes(1, max_tasks), _codes(0, 2 * max_tasks), _ORDERS, pinning)


def dag_from(codes: DagCodes, pin_to: Sequence[NodeId], dag_id: str = "dag") -> DAG:
    """Return the DAG that was drawn, pinned to these nodes only."""
    task_codes, edge_codes, order, pinning = codes
    ids = [TaskId(f"T{k}") for k in _ordered(range(len(task_codes)), order)]
    pins: list[NodeId | None] = [*pin_to] if pin_to and pinning != "none" else [None]
    if pinning == "some":
        pins.append(None)
    drawn = [_Digits(code) for code in task_codes]
    tasks = [Task(n, d.pick(COSTS), d.pick(pins)) for n, d in zip(ids, drawn, strict=True)]
    pairs = [(a, b) for k, a in enumerate(ids) for b in ids[k + 1 :]]
    edges = [_Digits(code) for code in (edge_codes if pairs else ())]
    sizes = {each.pick(pairs): each.pick(SIZES_MB) for each in edges}
    return DAG(
        DagId(dag_id),
        tuple(_ordered(tasks, order)),
        tuple(Dependency(*ends, size_MB) for ends, size_MB in sizes.items()),
    )


def questions_about(drawn: SearchStrategy[Network]) -> SearchStrategy[Case]:
    """Return questions about a network alone."""
    return _made(Case, drawn)


@cache
def instances(*, max_nodes: int = 4, max_tasks: int = 6) -> SearchStrategy[Case]:
    """Return a network and a DAG to place on it."""

    def case(network: Network, codes: DagCodes) -> Case:
        return Case(network, dag=dag_from(codes, [node.id for node in network.nodes]))

    return _made(case, networks(max_nodes=max_nodes), dag_codes(max_tasks=max_tasks))


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
    return _made(
        case,
        networks(max_nodes=max_nodes, max_links=max_links, is_bandwidth_optional=True),
        st.lists(number, max_size=max_links),
        st.lists(number, max_size=16),
    )


@cache
def waiting_lines(*, max_length: int = 12) -> SearchStrategy[Case]:
    """Return pushes and pops of tasks that became ready one after another."""
    return _made(_waiting_line, _codes(0, max_length))


def _waiting_line(codes: Sequence[int]) -> Case:
    waiting: list[WaitingTask | None] = []
    ready_us = 0
    for ticket, digits in enumerate(map(_Digits, codes)):
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
    return _made(case, networks(max_nodes=3, max_links=2), listed)
