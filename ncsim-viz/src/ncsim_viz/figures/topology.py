"""``--kind topology``: where nodes are, and what each link carried."""

import math
from pathlib import Path
from typing import Any, Final, TypeAlias

from ncsim_core.sweep.drawing import figure_at
from ncsim_core.trace.run_trace import RunTrace

from ncsim_viz.figures.words import plain

Point: TypeAlias = tuple[float, float]

SIDE_in: Final = 6.0
NAMED_UP_TO: Final = 100
"""Nodes; above, names would only cover each other."""
SPACIOUS: Final = 40
"""Nodes that have room for circles of full size."""
BEND: Final = 0.12
"""So that both directions of a pair are seen."""


def draw(run: RunTrace, path: Path) -> None:
    """Draw the network: width and shade of a link are the MB that it carried.

    Raises:
        ScenarioError: matplotlib is not installed, or ``path`` is no picture's.
    """
    places, are_metres = _places(run)
    is_named = len(run.nodes) <= NAMED_UP_TO
    with figure_at(path, SIDE_in, _height_in(places)) as figure:
        axes = figure.subplots()
        served_MB = _served_MB(run)
        _add_links(axes, run, places, served_MB)
        _add_nodes(axes, run, places)
        axes.set_aspect("equal")
        axes.margins(0.12)
        title = f"{plain(run.header.scenario or 'run')}: what links carried"
        note = "number in a node: tasks placed there" if is_named else "filled: tasks placed there"
        axes.set_title(f"{title}\n{note}", fontsize=9)
        axes.grid(visible=False)
        if are_metres:
            axes.set(xlabel="x (m)", ylabel="y (m)")
        else:
            axes.set_axis_off()


def _places(run: RunTrace) -> tuple[list[Point], bool]:
    """Return where to draw the nodes: at their positions, or on a circle if one has none."""
    known = [(node.x_m, node.y_m) for node in run.nodes]
    if all(x is not None and y is not None for x, y in known):
        return [(x or 0.0, y or 0.0) for x, y in known], True
    turns = (2 * math.pi * number / len(known) for number in range(len(known)))
    return [(math.sin(turn), math.cos(turn)) for turn in turns], False


def _height_in(places: list[Point]) -> float:
    """Return a height that leaves little of the paper empty."""
    xs, ys = [x for x, _ in places], [y for _, y in places]
    steepness = (max(ys) - min(ys)) / (max(xs) - min(xs) or 1.0)
    return min(SIDE_in, max(3.0, 1.4 + SIDE_in * 0.75 * steepness))


def _density(run: RunTrace) -> float:
    """Return by how much smaller than in a small network everything is drawn, at most 1."""
    return min(1.0, SPACIOUS / len(run.nodes))


def _served_MB(run: RunTrace) -> list[float]:
    served_MB = [0.0] * len(run.links)
    for transfer in run.transfers:
        for link in transfer.route:
            served_MB[link] += transfer.served_MB
    return served_MB


def _add_links(axes: Any, run: RunTrace, places: list[Point], served_MB: list[float]) -> None:  # noqa: ANN401
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.patches import FancyArrowPatch

    most_MB = max(served_MB, default=0.0) or 1.0
    size = math.sqrt(_density(run))
    shades = colormaps["viridis_r"]
    for link, carried_MB in zip(run.links, served_MB, strict=True):
        share = carried_MB / most_MB
        arrow = FancyArrowPatch(
            places[link.source], places[link.target],
            connectionstyle=f"arc3,rad={BEND}", arrowstyle="-|>" if carried_MB else "-",
            mutation_scale=8 * size, shrinkA=9 * size, shrinkB=9 * size,
            color=shades(0.1 + 0.9 * share) if carried_MB else "0.85",
            linewidth=size * (0.8 + 3.2 * share if carried_MB else 0.6),
            linestyle="-" if link.medium == "wireless" else ":",
            zorder=2 + share if carried_MB else 1,
        )  # fmt: skip
        axes.add_patch(arrow)
    if any(served_MB):
        scale = ScalarMappable(Normalize(0, most_MB), "viridis_r")
        axes.figure.colorbar(scale, ax=axes, shrink=0.6, label="carried (MB)")


def _add_nodes(axes: Any, run: RunTrace, places: list[Point]) -> None:  # noqa: ANN401
    counts = [0] * len(run.nodes)
    for task in run.tasks:
        if task.node is not None:
            counts[task.node] += 1
    xs, ys = zip(*places, strict=True)
    colours = ["#0072B2" if count else "white" for count in counts]
    size = _density(run)
    axes.scatter(xs, ys, s=190 * size, c=colours, edgecolors="0.3", linewidths=0.8 * size, zorder=4)
    if len(places) > NAMED_UP_TO:
        return
    for node, count, (x, y) in zip(run.nodes, counts, places, strict=True):
        if count:
            axes.text(
                x, y, str(count), ha="center", va="center", color="white", fontsize=7, zorder=5
            )
        axes.annotate(
            plain(node.id), (x, y), xytext=(7, 7), textcoords="offset points", fontsize=7, zorder=6,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.4},
        )  # fmt: skip
