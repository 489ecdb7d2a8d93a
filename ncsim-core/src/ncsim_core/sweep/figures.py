"""Figures of a study, drawn with matplotlib (extra ``plots``)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ncsim_core.errors import ScenarioError
from ncsim_core.metrics.statistics import mean_interval
from ncsim_core.sweep.report import column_of, parameters, policies
from ncsim_core.sweep.table import Table, shown_value

MAX_LEGEND = 12
"""Lines that a legend names; more would hide the picture."""


def draw_means(runs: Table, along: str, measure: str, path: Path) -> None:
    """Draw a measure along one column: a line with intervals for each combination of the others.

    Raises:
        ScenarioError: The column is not varied, or matplotlib is not installed.
    """
    along = column_of(runs, along)
    others = [each for each in parameters(runs) if each != along]
    lines: dict[str, dict[str, list[float | None]]] = {}
    for record in runs.to_dicts():
        name = ", ".join(shown_value(record[each]) for each in others) or measure
        lines.setdefault(name, {}).setdefault(shown_value(record[along]), []).append(
            record[measure]
        )
    figure, axes = _new_figure()
    for name, points in lines.items():
        intervals = [mean_interval(values) for values in points.values()]
        means = [float("nan") if each.mean is None else each.mean for each in intervals]
        margins = [0.0 if e.high is None or e.mean is None else e.high - e.mean for e in intervals]
        axes.errorbar(list(points), means, yerr=margins, marker="o", capsize=3, label=name)
    axes.set(xlabel=along, ylabel=measure, title=runs.title)
    if len(lines) <= MAX_LEGEND:
        axes.legend(fontsize="x-small")
    _save(figure, path)


def draw_regret(runs: Table, policy: str, mode: str, path: Path) -> None:
    """Draw a bar per case: Full makespan of the Solo choice over the best; inversions in red.

    Source: fig:regret_scatter.

    Raises:
        ScenarioError: A column is not varied, or matplotlib is not installed.
    """
    matrix = policies(runs, policy, mode)
    records = [each for each in matrix.to_dicts() if each["regret"] is not None]
    heads = matrix.columns[: matrix.columns.index("seed")]
    labels = [_label(record, heads) for record in records]
    figure, axes = _new_figure()
    colours = ["tab:red" if record["inversion"] else "tab:blue" for record in records]
    axes.bar(range(len(records)), [1 + record["regret"] for record in records], color=colours)
    axes.set_xticks(range(len(records)), labels, rotation=90, fontsize="x-small")
    axes.set(ylabel="Full makespan of the Solo choice / best", title=matrix.title)
    _save(figure, path)


def _label(record: Mapping[str, Any], heads: tuple[str, ...]) -> str:
    return "/".join(shown_value(record[each]) for each in heads) or str(record["seed"])


def _new_figure() -> tuple[Any, Any]:
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise ScenarioError("figures need matplotlib: pip install 'ncsim-core[plots]'") from None
    figure = Figure(figsize=(7, 4), layout="constrained")
    return figure, figure.subplots()


def _save(figure: Any, path: Path) -> None:  # noqa: ANN401 - a matplotlib figure
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=150)
