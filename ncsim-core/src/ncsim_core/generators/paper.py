"""The inputs of the paper's workflow studies (Section VII): three DAGs on square grids."""

from collections.abc import Iterator
from typing import Final

from ncsim_core.network import Link, LinkId, Network, Node, NodeId, Position
from ncsim_core.workflow import DAG, DagId, Dependency, Task, TaskId

SPACING_m: Final = 40.0
CAPACITIES: Final = (
    200.0, 100.0, 150.0, 80.0, 300.0, 120.0, 250.0, 180.0,
    160.0, 90.0, 220.0, 140.0, 280.0, 110.0, 190.0, 170.0,
)  # fmt: skip
"""Compute units per second, node by node, then from the start again (Section VII)."""

COMPUTE_COST: Final = 500.0
PAYLOAD_MB: Final = 10.0

LISTING_ORDERS: Final = {
    5: "0 2 1 3 4",
    10: "0 2 4 1 3 6 8 7 5 9",
    20: "0 2 4 1 3 7 10 6 5 9 8 13 11 12 16 14 15 17 18 19",
}
"""By number of tasks, the order in which the study's files list them; round_robin follows it."""

FOLLOWERS: Final = {
    5: {0: (1, 2, 3), 1: (4,), 2: (4,), 3: (4,)},
    10: {
        0: (1, 2, 3, 4),
        1: (5, 7), 2: (6, 8), 3: (5, 7), 4: (6, 8),
        5: (9,), 6: (9,), 7: (9,), 8: (9,),
    },
    20: {
        0: (1, 2, 3, 4),
        1: (5, 6), 2: (6, 7), 3: (8, 9), 4: (9, 10),
        5: (11, 12), 6: (12, 13), 7: (13, 14), 8: (14, 15), 9: (15, 16), 10: (16, 11),
        11: (17,), 12: (17,), 13: (18,), 14: (18,), 15: (19,), 16: (19,),
    },
}  # fmt: skip
"""By number of tasks, the tasks that each task feeds, in file order."""


def paper_grid(size: int) -> Network:
    """Return the ``size`` x ``size`` grid with right, lower and checkerboard diagonal links."""
    nodes = tuple(
        Node(NodeId(f"n{number}"), CAPACITIES[number % len(CAPACITIES)], _position(number, size))
        for number in range(size * size)
    )
    links = tuple(
        _link(*ends) for a, b in sorted(_neighbour_pairs(size)) for ends in ((a, b), (b, a))
    )
    return Network(nodes, links)


def paper_dag(tasks: int, *, payload_MB: float = PAYLOAD_MB, dag_id: str | None = None) -> DAG:
    """Return the study's DAG of 5 (fork-join), 10 (diamond) or 20 (pipeline) tasks.

    Raises:
        KeyError: There is no such DAG in the study.
    """
    listing = [TaskId(f"T{number}") for number in LISTING_ORDERS[tasks].split()]
    dependencies = tuple(
        Dependency(TaskId(f"T{source}"), TaskId(f"T{target}"), payload_MB)
        for source, targets in FOLLOWERS[tasks].items()
        for target in targets
    )
    name = DagId(dag_id or f"dag_{tasks}")
    return DAG(name, tuple(Task(task, COMPUTE_COST) for task in listing), dependencies)


def parallel_links(count: int, separation_m: float, length_m: float = 30.0) -> Network:
    """Return ``count`` links side by side, as in the paper's radio experiments (Section VI)."""
    nodes = []
    links = []
    for i in range(count):
        sender, receiver = NodeId(f"s{i}"), NodeId(f"r{i}")
        nodes.append(Node(sender, 1.0, Position(0.0, separation_m * i)))
        nodes.append(Node(receiver, 1.0, Position(length_m, separation_m * i)))
        links.append(Link(LinkId(f"l{i}"), sender, receiver))
    return Network(tuple(nodes), tuple(links))


def _position(number: int, size: int) -> Position:
    row, column = divmod(number, size)
    return Position(SPACING_m * column, SPACING_m * row)


def _neighbour_pairs(size: int) -> Iterator[tuple[int, int]]:
    """Yield the linked pairs of a grid, smaller number first."""
    for row in range(size):
        for column in range(size):
            here = row * size + column
            if column + 1 < size:
                yield here, here + 1
            if row + 1 < size:
                yield here, here + size
                leans_right = (row + column) % 2 == 0
                diagonal = column + 1 if leans_right else column - 1
                if 0 <= diagonal < size:
                    yield here, here + size + (1 if leans_right else -1)


def _link(source: int, target: int) -> Link:
    return Link(LinkId(f"l_n{source}_n{target}"), NodeId(f"n{source}"), NodeId(f"n{target}"))
