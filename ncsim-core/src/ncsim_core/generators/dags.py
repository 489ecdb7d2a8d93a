"""DAGs by rule: chain, fork-join, diamond, layered random, out-tree, Gaussian elimination, FFT.

A *form* is the names of the tasks, in file order, and who feeds whom. ``dag_of`` turns it into a
``DAG`` whose costs and payloads may be drawn.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

from ncsim_core.errors import ScenarioError
from ncsim_core.generators.amounts import Amount, amounts
from ncsim_core.generators.paper import COMPUTE_COST, FOLLOWERS, LISTING_ORDERS, PAYLOAD_MB
from ncsim_core.generators.streams import Draws
from ncsim_core.workflow import DAG, DagId, Dependency, Task, TaskId


class Form(NamedTuple):
    """The names of tasks in file order, and the edges between them."""

    tasks: Sequence[str]
    edges: Sequence[tuple[str, str]]


@dataclass(frozen=True)
class Workload:
    """What tasks cost and dependencies carry.

    Args:
        compute_cost: Compute units (stream ``workload.cost`` if drawn).
        payload_MB: Per dependency (stream ``workload.payload`` if drawn).
    """

    compute_cost: Amount = COMPUTE_COST
    payload_MB: Amount = PAYLOAD_MB


def dag_of(
    form: Form,
    workload: Workload | None = None,
    draws: Draws | None = None,
    *,
    number: int = 0,
    dag_id: str | None = None,
) -> DAG:
    """Return the DAG of a form.

    Args:
        form: Tasks and edges.
        workload: Costs and payloads.
        draws: Random streams.
        number: Which of several DAGs of one scenario; each has streams of its own.
        dag_id: Name; by default ``dag_`` and the number.
    """
    workload, draws = workload or Workload(), draws or Draws()
    costs = amounts(workload.compute_cost, len(form.tasks), draws.stream("workload.cost", number))
    payloads_MB = amounts(
        workload.payload_MB, len(form.edges), draws.stream("workload.payload", number)
    )
    return DAG(
        DagId(dag_id or f"dag_{number}"),
        tuple(Task(TaskId(name), cost) for name, cost in zip(form.tasks, costs, strict=True)),
        tuple(
            Dependency(TaskId(source), TaskId(target), size_MB)
            for (source, target), size_MB in zip(form.edges, payloads_MB, strict=True)
        ),
    )


def paper_form(tasks: int) -> Form:
    """Return the study's form of 5, 10 or 20 tasks, in its listing order.

    Raises:
        ScenarioError: There is no such DAG in the study.
    """
    if tasks not in FOLLOWERS:
        raise ScenarioError(f"the paper's DAGs have 5, 10 or 20 tasks, not {tasks}")
    names = [f"T{number}" for number in LISTING_ORDERS[tasks].split()]
    return Form(names, _edges((s, t) for s, targets in FOLLOWERS[tasks].items() for t in targets))


def chain(tasks: int) -> Form:
    """Return tasks one after the other."""
    return Form(_names(tasks), _edges((number, number + 1) for number in range(tasks - 1)))


def fork_join(width: int) -> Form:
    """Return a first task, ``width`` tasks that it feeds, and a last one that they feed."""
    last = width + 1
    middle = range(1, last)
    edges = [*((0, task) for task in middle), *((task, last) for task in middle)]
    return Form(_names(width + 2), _edges(edges))


def diamond(size: int) -> Form:
    """Return a lattice of ``size`` x ``size`` tasks, each feeding its right and lower neighbour.

    With size 2 that is the diamond of four tasks; larger ones are wavefront computations.
    """
    edges = []
    for row, column in product(range(size), repeat=2):
        here = row * size + column
        edges += [(here, here + 1)] if column + 1 < size else []
        edges += [(here, here + size)] if row + 1 < size else []
    return Form(_names(size * size), _edges(edges))


def layered_random(
    draws: Draws, layers: int, width: int, *, density: float = 0.3, number: int = 0
) -> Form:
    """Return layers of equally many tasks, linked at random to the layer above.

    Every task below the first layer has one feeder at least (stream ``workload.form``).

    Args:
        draws: Random streams.
        layers: How many.
        width: Tasks per layer.
        density: Probability of any other edge between neighbouring layers.
        number: Which of several DAGs of one scenario.
    """
    stream = draws.stream("workload.form", number)
    edges = []
    for task in range(width, layers * width):
        above = task // width * width - width
        sure = int(stream.integers(width))
        drawn = stream.random(width) < density
        edges += [(above + each, task) for each in range(width) if each == sure or drawn[each]]
    return Form(_names(layers * width), _edges(edges))


def out_tree(depth: int, branching: int) -> Form:
    """Return a tree whose root feeds ``branching`` tasks, and so on, ``depth`` levels below it."""
    tasks = sum(branching**level for level in range(depth + 1))
    return Form(
        _names(tasks), _edges(((child - 1) // branching, child) for child in range(1, tasks))
    )


def gaussian_elimination(size: int) -> Form:
    """Return the elimination of a ``size`` x ``size`` matrix: pivots and column updates.

    Source: Topcuoglu, Hariri, Wu (2002), Section 5.3: (size^2 + size - 2) / 2 tasks.

    Args:
        size: Of the matrix, at least 2.
    """
    names, edges = [], []
    for k in range(1, size):
        names += [f"P{k}", *(f"U{k}_{j}" for j in range(k + 1, size + 1))]
        edges += [(f"P{k}", f"U{k}_{j}") for j in range(k + 1, size + 1)]
        if k + 1 < size:
            edges.append((f"U{k}_{k + 1}", f"P{k + 1}"))
            edges += [(f"U{k}_{j}", f"U{k + 1}_{j}") for j in range(k + 2, size + 1)]
    return Form(names, edges)


def fft(points: int) -> Form:
    """Return the fast Fourier transform: a tree of recursive calls, then butterflies.

    Source: Topcuoglu, Hariri, Wu (2002), Section 5.3: 2m - 1 calls, m log2 m butterflies.

    Args:
        points: A power of 2.

    Raises:
        ScenarioError: It is none.
    """
    if points < 1 or points & (points - 1):
        raise ScenarioError(f"an FFT has a power of 2 points, not {points}")
    calls = 2 * points - 1
    stages = points.bit_length() - 1
    edges = [(f"C{(child - 1) // 2}", f"C{child}") for child in range(1, calls)]
    names = [f"C{number}" for number in range(calls)]
    below = [f"C{points - 1 + lane}" for lane in range(points)]
    for stage in range(stages):
        layer = [f"B{stage}_{lane}" for lane in range(points)]
        for lane, name in enumerate(layer):
            edges += [(below[lane], name), (below[lane ^ (1 << stage)], name)]
        names += layer
        below = layer
    return Form(names, edges)


def _names(count: int) -> list[str]:
    return [f"T{number}" for number in range(count)]


def _edges(pairs: Iterable[tuple[int, int]]) -> list[tuple[str, str]]:
    return [(f"T{source}", f"T{target}") for source, target in pairs]
