"""``--kind dag``: workflows, where their tasks ran, and the chain that made the makespan."""

import math
from itertools import pairwise
from pathlib import Path
from typing import Any, Final, TypeAlias

from ncsim_core.errors import ScenarioError
from ncsim_core.metrics.explanation import explain_run
from ncsim_core.sweep.drawing import COLOURS, figure_at
from ncsim_core.trace.records import TraceError
from ncsim_core.trace.run_trace import RunDag, RunTrace

from ncsim_viz.figures.words import plain

Point: TypeAlias = tuple[float, float]

MAX_DAGS: Final = 12
"""DAGs that a figure shows, the first; its title says how many there are."""
COLUMNS: Final = 3
NAMED_UP_TO: Final = 300
"""Tasks of a DAG; above, circles with names would only cover each other."""
LAYER_in: Final = 1.15
TASK_in: Final = 0.85
MARGIN_in: Final = 0.9
MAX_SIDE_in: Final = 60.0
MAX_DOTS_in: Final = 10.0
DARK: Final = frozenset({"#0072B2", "#009E73", "#000000"})
"""Colours that white text is read on."""
SWEEPS: Final = 8
"""Passes that order the tasks of each layer by the middle of their neighbours."""


def draw(run: RunTrace, path: Path) -> None:
    """Draw each DAG in layers: a task's colour and second line are its node.

    Raises:
        ScenarioError: No DAG entered the run, matplotlib is missing, or ``path`` is no picture's.
    """
    shown = run.dags[:MAX_DAGS]
    if not shown:
        raise ScenarioError("no DAG entered this run; there is nothing to draw")
    columns = min(COLUMNS, len(shown))
    rows = math.ceil(len(shown) / columns)
    panels = [_Panel(dag, run) for dag in shown]
    layers, widest = (max(getattr(each, name) for each in panels) for name in ("layers", "widest"))
    is_named = max(dag.task_count for dag in shown) <= NAMED_UP_TO
    limit_in = MAX_SIDE_in if is_named else MAX_DOTS_in
    width_in = min(limit_in, columns * (MARGIN_in + LAYER_in * layers))
    height_in = min(limit_in, rows * (MARGIN_in + TASK_in * widest))
    colours = _colours(run)
    with figure_at(path, width_in, height_in) as figure:
        all_axes = list(figure.subplots(rows, columns, squeeze=False).flat)
        for axes, panel in zip(all_axes, panels, strict=False):
            _draw_panel(axes, panel, colours)
        for axes in all_axes:
            axes.set_axis_off()
        figure.suptitle(_title(run, len(shown)), fontsize=9)


class _Panel:
    """One DAG, laid out."""

    def __init__(self, dag: RunDag, run: RunTrace) -> None:
        self.run = run
        self.dag = dag
        self.tasks = range(dag.first_task, dag.first_task + dag.task_count)
        self.edges = [edge for edge in run.transfers if edge.dag == dag.number]
        self.places = layered(self.tasks, [(edge.source, edge.target) for edge in self.edges])
        self.chain = _chain(run)
        xs = [x for x, _ in self.places.values()]
        self.layers = len(set(xs))
        self.widest = max(xs.count(x) for x in set(xs))


def _colours(run: RunTrace) -> dict[int | None, str]:
    """Return a colour for each node that tasks were placed on; beyond seven they recur."""
    used = sorted({task.node for task in run.tasks if task.node is not None})
    return {node: COLOURS[at % len(COLOURS)] for at, node in enumerate(used)} | {None: "0.8"}


def _title(run: RunTrace, shown: int) -> str:
    some = f", the first {shown} of {len(run.dags)} DAGs" if shown < len(run.dags) else ""
    bold = "; bold: the chain that made the makespan" if _chain(run) else ""
    return f"{plain(run.header.scenario or 'run')}{some}\ndotted: within a node{bold}"


def _chain(run: RunTrace) -> tuple[int, ...]:
    """Return the tasks of the binding chain in order; none if the run has no makespan."""
    try:
        chain = explain_run(run).chain
    except TraceError:
        return ()
    numbers = {run.task_label(task.number): task.number for task in run.tasks}
    return tuple(numbers[item.label] for item in chain if item.kind == "task")


def _draw_panel(axes: Any, panel: _Panel, colours: dict[int | None, str]) -> None:  # noqa: ANN401
    axes.set_title(plain(panel.dag.id), fontsize=8)
    if len(panel.tasks) > NAMED_UP_TO:
        _draw_many(axes, panel, colours)
        return
    widest_MB = max((edge.size_MB for edge in panel.edges), default=0.0) or 1.0
    bold = set(pairwise(panel.chain))
    for edge in panel.edges:
        is_bold = (edge.source, edge.target) in bold
        axes.annotate(
            "", panel.places[edge.target], panel.places[edge.source],
            arrowprops={
                "arrowstyle": "-|>", "shrinkA": 13, "shrinkB": 13,
                "linewidth": (2.2 if is_bold else 0.5) + 0.8 * edge.size_MB / widest_MB,
                "color": "black" if is_bold else "0.55",
                "linestyle": ":" if edge.is_local else "-",
            },
        )  # fmt: skip
    for number in panel.tasks:
        _draw_task(axes, number, panel, colours[panel.run.tasks[number].node])
    axes.margins(0.12)


def _draw_many(axes: Any, panel: _Panel, colours: dict[int | None, str]) -> None:  # noqa: ANN401
    """Draw a DAG too large for names: dots and lines."""
    from matplotlib.collections import LineCollection

    bold = set(pairwise(panel.chain))
    ends = [(edge.source, edge.target) for edge in panel.edges]
    lines = LineCollection(
        [[panel.places[source], panel.places[target]] for source, target in ends],
        colors=["black" if each in bold else "0.75" for each in ends],
        linewidths=[1.4 if each in bold else 0.3 for each in ends],
        rasterized=True,
    )
    axes.add_collection(lines)
    xs, ys = zip(*(panel.places[number] for number in panel.tasks), strict=True)
    shades = [colours[panel.run.tasks[number].node] for number in panel.tasks]
    axes.scatter(xs, ys, s=4, c=shades, zorder=3, rasterized=True)


def _draw_task(axes: Any, number: int, panel: _Panel, colour: str) -> None:  # noqa: ANN401
    task, place = panel.run.tasks[number], panel.places[number]
    node = "?" if task.node is None else panel.run.nodes[task.node].id
    axes.scatter(
        *place, s=560, c=colour, edgecolors="black", zorder=3,
        linewidths=2.4 if number in panel.chain else 0.6,
    )  # fmt: skip
    ink = "white" if colour in DARK else "black"
    text = f"{plain(task.id)}\n{plain(node)}"
    axes.text(*place, text, ha="center", va="center", color=ink, fontsize=6.5, zorder=4)


def layered(tasks: range, edges: list[tuple[int, int]]) -> dict[int, Point]:
    """Return a place for each task: layers by longest path, few crossings within them."""
    before: dict[int, list[int]] = {task: [] for task in tasks}
    after: dict[int, list[int]] = {task: [] for task in tasks}
    for source, target in edges:
        before[target].append(source)
        after[source].append(target)
    depth = _depths(before, after)
    layers: list[list[int]] = [[] for _ in range(max(depth.values()) + 1)]
    for task in tasks:
        layers[depth[task]].append(task)
    at = {task: place for layer in layers for place, task in enumerate(layer)}
    for sweep in range(SWEEPS):
        neighbours = after if sweep % 2 else before
        for layer in reversed(layers) if sweep % 2 else layers:
            _reorder(layer, neighbours, at)
    return {
        task: (float(number), (len(layer) - 1) / 2 - at[task])
        for number, layer in enumerate(layers)
        for task in layer
    }


def _depths(before: dict[int, list[int]], after: dict[int, list[int]]) -> dict[int, int]:
    """Return the number of edges on the longest path to each task."""
    depth = dict.fromkeys(before, 0)
    open_inputs = {task: len(sources) for task, sources in before.items()}
    ready = [task for task, count in open_inputs.items() if not count]
    while ready:
        task = ready.pop()
        for target in after[task]:
            depth[target] = max(depth[target], depth[task] + 1)
            open_inputs[target] -= 1
            if not open_inputs[target]:
                ready.append(target)
    return depth


def _reorder(layer: list[int], neighbours: dict[int, list[int]], at: dict[int, int]) -> None:
    def middle(task: int) -> float:
        around = neighbours[task]
        return sum(at[each] for each in around) / len(around) if around else at[task]

    layer.sort(key=lambda task: (middle(task), task))
    at.update({task: place for place, task in enumerate(layer)})
