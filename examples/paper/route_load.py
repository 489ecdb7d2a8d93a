"""fig:routing-topo: how many dependencies each link of the 4x4 grid carries, under two routings."""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ncsim_core import RunResult, simulate
from ncsim_core.generators.paper import paper_dag, paper_grid
from ncsim_core.network import Network
from ncsim_core.scenario.making import make_scenario
from ncsim_core.sweep.drawing import figure_at

SIZE = 4
TASKS = 20
Ends = tuple[str, str]


@dataclass(frozen=True)
class RouteLoad:
    """What one run of HEFT puts on the links.

    Args:
        routing: Name of the routing model.
        result: The run, in Full.
        dependencies: By undirected link (its nodes in order), how many dependencies cross it.
    """

    routing: str
    result: RunResult
    dependencies: Counter[Ends]

    @property
    def mean_hops(self) -> float:
        """Return the MB-hops per MB between nodes."""
        return self.result.route_work_MB_hops / self.result.remote_MB


def route_load(routing: str) -> RouteLoad:
    """Return the load of the links under a routing model."""
    network = paper_grid(SIZE)
    config = {"scheduler": "heft", "routing": routing, "interference": "csma_bianchi"}
    result = simulate(make_scenario("route load", network, [paper_dag(TASKS)], config))
    ends = {link.id: _in_order(link.source, link.target) for link in network.links}
    crossed = Counter(ends[link] for each in result.transfers for link in each.route)
    return RouteLoad(routing, result, crossed)


def draw_route_load(loads: list[RouteLoad], path: Path) -> None:
    """Draw the grid once per routing; thickness and colour show how many cross a link."""
    network = paper_grid(SIZE)
    most = max(max(load.dependencies.values()) for load in loads)
    with figure_at(path, width_in=3.6 * len(loads), height_in=4.0) as figure:
        for axes, load in zip(figure.subplots(1, len(loads)), loads, strict=True):
            shades = _draw_links(axes, network, load, most)
            _draw_nodes(axes, network)
            makespan_s = load.result.makespan_s or float("nan")
            axes.set_title(
                f"{load.routing}\n{load.result.route_work_MB_hops:g} MB-hops, {makespan_s:.2f} s"
            )
            axes.set_aspect("equal")
            axes.axis("off")
        figure.colorbar(shades, ax=figure.axes, location="bottom", shrink=0.5,
                        label="dependencies routed over a link")  # fmt: skip


def _draw_links(axes: Any, network: Network, load: RouteLoad, most: int) -> Any:  # noqa: ANN401 - matplotlib
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    shades = ScalarMappable(Normalize(0, most), "YlOrRd")
    places = {node.id: node.position for node in network.nodes}
    for one, other in sorted({_in_order(link.source, link.target) for link in network.links}):
        count = load.dependencies[one, other]
        x, y = zip(*((p.x_m, -p.y_m) for p in (places[one], places[other]) if p), strict=True)
        colour = shades.to_rgba(count) if count else "0.85"
        axes.plot(x, y, color=colour, linewidth=1 + 7 * count / most, solid_capstyle="round")
        if count:
            middle = (sum(x) / 2, sum(y) / 2)
            box = {"boxstyle": "round,pad=0.15", "facecolor": "white", "linewidth": 0, "alpha": 0.8}
            axes.annotate(str(count), middle, ha="center", va="center", fontsize=7, bbox=box)
    return shades


def _draw_nodes(axes: Any, network: Network) -> None:  # noqa: ANN401 - matplotlib
    for node in network.nodes:
        if node.position is not None:
            at = (node.position.x_m, -node.position.y_m)
            axes.plot(*at, "o", markersize=15, color="white", markeredgecolor="0.2", zorder=3)
            axes.annotate(node.id, at, ha="center", va="center", fontsize=7, zorder=4)


def _in_order(one: str, other: str) -> Ends:
    return (one, other) if one < other else (other, one)
