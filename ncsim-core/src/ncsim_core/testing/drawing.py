"""How networks and DAGs are drawn: few draws, decoded by plain functions.

A node, link or task is one drawn number, taken apart digit by digit, because a draw costs
hypothesis far more than the arithmetic costs us.
"""

import random
from collections.abc import Callable, Sequence
from functools import cache
from typing import TypeAlias, TypeVar

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from ncsim_core.network import Link, LinkId, Medium, Network, Node, NodeId, Position
from ncsim_core.workflow import DAG, DagId, Dependency, Task, TaskId

T = TypeVar("T")

CAPACITIES = (50.0, 80.0, 100.0, 250.0)
BANDWIDTHS_MBps = (10.0, 2.5, 1.0, 40.0, 0.0)
MEDIA: tuple[Medium, ...] = ("wireless", "wireless", "wireless", "wired")
COORDINATES_m = tuple(25.0 * k for k in range(9))
LATENCIES_s = (0.0, 0.0, 0.01, 0.25)
COSTS = (100.0, 1.0, 500.0, 0.0)
SIZES_MB = (10.0, 1.0, 12.5, 0.0)


class Digits:
    """Takes choices out of one whole number, which costs one draw instead of many.

    0 means the first choice everywhere, so that shrinking leads to the plainest object.
    """

    def __init__(self, number: int) -> None:
        self._rest = number

    def pick(self, choices: Sequence[T]) -> T:
        """Return one of the choices."""
        self._rest, index = divmod(self._rest, len(choices))
        return choices[index]


def drawn_codes(min_size: int, max_size: int) -> SearchStrategy[list[int]]:
    """Return numbers for ``Digits``, one per object to be made."""
    return st.lists(st.integers(0, 2**24 - 1), min_size=min_size, max_size=max_size)


@st.composite
def made(draw: DrawFn, make: Callable[..., T], *parts: SearchStrategy[object]) -> T:
    """Return ``make`` of what is drawn; unlike ``builds``, failures show the object itself."""
    return make(*(draw(part) for part in parts))


ORDERS = st.integers(0, 3)
"""Seeds of file orders; 0 is the order of the ids."""


def ordered(items: Sequence[T], order: int) -> list[T]:
    """Return the items in one of a few orders; 0 leaves them as they are."""
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
        nodes, links = drawn_codes(min_nodes, max_nodes), drawn_codes(min_links, max_links)
        return made(_network, nodes, links, ORDERS, is_bare)

    return of(1, 0) | of(min(3, max_nodes), 3 * max_links // 4)


def _network(
    node_codes: Sequence[int],
    link_codes: Sequence[int],
    order: int,
    is_bare: bool,  # noqa: FBT001 - drawn in order
) -> Network:
    nodes = [_node(number, Digits(code)) for number, code in enumerate(node_codes)]
    pairs = [(a.id, b.id) for a in nodes for b in nodes if a is not b]
    links = [
        _link(f"l{number}", pairs, Digits(code), is_bare=is_bare)
        for number, code in enumerate(link_codes if pairs else ())
    ]
    return Network(tuple(ordered(nodes, order)), tuple(ordered(links, order)))


def _node(number: int, digits: Digits) -> Node:
    x_m, y_m = digits.pick(COORDINATES_m), digits.pick(COORDINATES_m)
    return Node(NodeId(f"n{number}"), digits.pick(CAPACITIES), Position(x_m, y_m))


def _link(
    name: str, pairs: Sequence[tuple[NodeId, NodeId]], digits: Digits, *, is_bare: bool
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
    return made(lambda codes: dag_from(codes, pin_to, dag_id), dag_codes(max_tasks=max_tasks))


DagCodes: TypeAlias = tuple[list[int], list[int], int, str]


@cache
def dag_codes(*, max_tasks: int) -> SearchStrategy[DagCodes]:
    """Return what ``dag_from`` makes a DAG of, once the nodes to pin to are known."""
    pinning = st.sampled_from(("none", "some", "all"))
    return st.tuples(drawn_codes(1, max_tasks), drawn_codes(0, 2 * max_tasks), ORDERS, pinning)


def dag_from(codes: DagCodes, pin_to: Sequence[NodeId], dag_id: str = "dag") -> DAG:
    """Return the DAG that was drawn, pinned to these nodes only."""
    task_codes, edge_codes, order, pinning = codes
    ids = [TaskId(f"T{k}") for k in ordered(range(len(task_codes)), order)]
    pins: list[NodeId | None] = [*pin_to] if pin_to and pinning != "none" else [None]
    if pinning == "some":
        pins.append(None)
    drawn = [Digits(code) for code in task_codes]
    tasks = [Task(n, d.pick(COSTS), d.pick(pins)) for n, d in zip(ids, drawn, strict=True)]
    pairs = [(a, b) for k, a in enumerate(ids) for b in ids[k + 1 :]]
    edges = [Digits(code) for code in (edge_codes if pairs else ())]
    sizes = {each.pick(pairs): each.pick(SIZES_MB) for each in edges}
    return DAG(
        DagId(dag_id),
        tuple(ordered(tasks, order)),
        tuple(Dependency(*ends, size_MB) for ends, size_MB in sizes.items()),
    )
