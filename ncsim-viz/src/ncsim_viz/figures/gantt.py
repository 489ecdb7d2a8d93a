"""``--kind gantt``: tasks and outgoing transfers by node."""

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import Any, Final

from ncsim_core.errors import ScenarioError
from ncsim_core.sweep.drawing import COLOURS, figure_at
from ncsim_core.trace.run_trace import RunTrace

from ncsim_viz.figures.words import plain
from ncsim_viz.gantt import Bar, Chart, Row, chart_of_run, rows_of

WIDTH_in: Final = 7.0
LANE_in: Final = 0.24
MAX_HEIGHT_in: Final = 40.0
RASTERISED_FROM: Final = 20_000
"""Bars from which on a vector file gets a picture of them instead of each."""
FONT_pt: Final = 6.0
CHARACTER_pt: Final = 0.62 * FONT_pt
FULL: Final = 0.86
"""Part of a lane that bars fill."""


def draw(run: RunTrace, path: Path) -> None:
    """Draw a run's Gantt chart; transfers are hatched, DAGs have colours.

    Raises:
        ScenarioError: Nothing began, matplotlib is not installed, or ``path`` is no picture's.
    """
    chart = chart_of_run(run)
    if not chart.bars:
        raise ScenarioError("nothing began in this run; there is nothing to draw")
    height_in = min(MAX_HEIGHT_in, 1.1 + LANE_in * max(3, len(chart.lanes)))
    with figure_at(path, WIDTH_in, height_in) as figure:
        axes = figure.subplots()
        rows = rows_of(chart)
        _add_bars(axes, rows)
        _add_labels(axes, rows, chart)
        axes.set_yticks(range(len(chart.lanes)), chart.lanes, fontsize=7)
        axes.set(xlim=(0, chart.end_s or 1), ylim=(len(chart.lanes) - 0.4, -0.6))
        axes.set(xlabel="time (s)", title=chart.title)
        axes.grid(visible=False, axis="y")
        _add_legend(axes, chart, [dag.id for dag in run.dags])


def _add_bars(axes: Any, rows: Sequence[Row]) -> None:  # noqa: ANN401 - matplotlib is untyped
    from matplotlib.collections import PolyCollection

    def look(row: Row) -> tuple[int, str]:
        return row.bar.dag % len(COLOURS), row.bar.kind

    for (dag, kind), group in groupby(sorted(rows, key=look), key=look):
        shapes = [_corners(row) for row in group]
        bars = PolyCollection(
            shapes,
            facecolor=COLOURS[dag] if kind == "task" else "white",
            edgecolor="white" if kind == "task" else COLOURS[dag],
            hatch=None if kind == "task" else "/////",
            linewidth=0.4,
            rasterized=len(rows) > RASTERISED_FROM,
        )
        axes.add_collection(bars)


def _corners(row: Row) -> list[tuple[float, float]]:
    top, bottom = _edges(row)
    start_s, end_s = row.bar.start_s, row.bar.end_s
    return [(start_s, top), (end_s, top), (end_s, bottom), (start_s, bottom)]


def _edges(row: Row) -> tuple[float, float]:
    top = row.bar.lane - FULL / 2 + FULL * row.bottom
    return top, top + FULL * row.height


def _add_labels(axes: Any, rows: Sequence[Row], chart: Chart) -> None:  # noqa: ANN401
    """Write the names that fit into their bars."""
    pt_per_s = WIDTH_in * 0.8 * 72 / (chart.end_s or 1)
    for row in rows:
        bar = row.bar
        room = (bar.end_s - bar.start_s) * pt_per_s
        if row.height * LANE_in * 72 >= FONT_pt and len(bar.label) * CHARACTER_pt < room:
            top, bottom = _edges(row)
            axes.text(
                (bar.start_s + bar.end_s) / 2, (top + bottom) / 2, plain(bar.label),
                ha="center", va="center", fontsize=FONT_pt, **_ink(bar),
            )  # fmt: skip


def _ink(bar: Bar) -> dict[str, object]:
    if bar.kind == "task":
        return {"color": "white"}
    return {"color": "black", "bbox": {"facecolor": "white", "edgecolor": "none", "pad": 0.6}}


def _add_legend(axes: Any, chart: Chart, dags: Sequence[str]) -> None:  # noqa: ANN401
    from matplotlib.patches import Patch

    grey = "0.35"
    entries = [Patch(facecolor=grey, label="task")]
    if any(bar.kind == "transfer" for bar in chart.bars):
        entries.append(Patch(facecolor="white", edgecolor=grey, hatch="/////", label="transfer"))
    if 1 < len(dags) <= len(COLOURS):
        entries += [Patch(facecolor=COLOURS[at], label=dag) for at, dag in enumerate(dags)]
    axes.figure.legend(handles=entries, loc="outside lower center", ncols=min(5, len(entries)))
