"""A failing example in words: the network, the workflow and what else a component was asked."""

from collections.abc import Iterator, Mapping, Sequence

from ncsim_core.errors import some_of
from ncsim_core.network import Link, Node
from ncsim_core.testing.questions import Case
from ncsim_core.workflow import DAG, Task

MOST_ROWS = 12
"""Nodes, links, tasks or edges that are listed."""


def example_text(
    options: Mapping[str, object],
    sections: Mapping[str, Mapping[str, object]],
    values: Mapping[str, object],
) -> str:
    """Return the example, one thing per line and indented; what is empty is left out.

    Args:
        options: Options of the component.
        sections: Config sections that are not the defaults.
        values: What else was drawn, by parameter of the check.
    """
    lines = [f"  options: {dict(options)}"] if options else []
    lines += [f"  {name}: {dict(values)}" for name, values in sections.items()]
    for name, value in values.items():
        lines += [f"  {name}: {line}" for line in _lines(value)]
    return "\n".join(lines)


def _lines(value: object) -> Iterator[str]:
    if not isinstance(value, Case):
        yield repr(value)
        return
    yield f"nodes {_listed([_node(each) for each in value.network.nodes])}"
    yield f"links {_listed([_link(each) for each in value.network.links])}"
    dags = [value.dag] if value.dag else []
    for dag in dags:
        yield _dag(dag)
    for injection in value.injections:
        yield f"at {injection.at_us} us {_dag(injection.dag)}"
    rest = {"active": value.active, "toggles": value.toggles, "routes": value.routes}
    yield from (f"{name} {list(some)}" for name, some in rest.items() if some)
    if value.waiting:
        yield f"pushes, and pops as None: {list(value.waiting)}"


def _node(node: Node) -> str:
    at = f", at {node.position.x_m:g}, {node.position.y_m:g} m" if node.position else ""
    return f"{node.id} ({node.compute_capacity:g} units/s{at})"


def _link(link: Link) -> str:
    bandwidth = "" if link.bandwidth_MBps is None else f", {link.bandwidth_MBps:g} MB/s"
    return f"{link.id} ({link.source} -> {link.target}{bandwidth})"


def _dag(dag: DAG) -> str:
    edges = [
        f"{each.source} -> {each.target} ({each.data_size_MB:g} MB)" for each in dag.dependencies
    ]
    tasks = [_task(each) for each in dag.tasks]
    return f"DAG {dag.id}: tasks {_listed(tasks)}; edges {_listed(edges)}"


def _task(task: Task) -> str:
    pin = f" on {task.pinned_to}" if task.pinned_to else ""
    return f"{task.id} ({task.compute_cost:g} units{pin})"


def _listed(rows: Sequence[str]) -> str:
    return some_of(rows, MOST_ROWS) or "none"
