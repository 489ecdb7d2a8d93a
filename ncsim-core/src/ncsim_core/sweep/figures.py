"""Figures of a study, drawn with matplotlib (extra ``plots``)."""

import importlib
import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from ncsim_core.metrics.statistics import MeanInterval, mean_interval, slowdown
from ncsim_core.sweep.drawing import INVERTED, PLAIN, figure_at, style
from ncsim_core.sweep.formatting import quantity, shown_value
from ncsim_core.sweep.report import (
    SOLO,
    check_measure,
    column_of,
    full_mode,
    grouped,
    parameters,
    policies,
)
from ncsim_core.sweep.table import Table

MAX_LEGEND: Final = 12
"""Lines that a legend names; more would hide the picture."""
LEGEND_COLUMNS: Final = 3
WIDE: Final = 30.0
"""Ratio of the ends of an axis from which on it is logarithmic."""

Point = tuple[Any, MeanInterval]


class Line(NamedTuple):
    """Means with intervals along an axis, and what they are of."""

    name: str
    points: list[Point]


def draw_means(runs: Table, along: str, measure: str, path: Path) -> None:
    """Draw a measure along one column: a line with intervals for each combination of the others.

    Raises:
        ScenarioError: The column is not varied, there is no such measure, or matplotlib is not
            installed.
    """
    check_measure(measure)
    along = column_of(runs, along)
    others = [each for each in parameters(runs) if each != along]
    lines = [
        _line(group, others, along, lambda records: [each[measure] for each in records])
        for group in grouped(runs.to_dicts(), others)
    ]
    labels = {"xlabel": quantity(along), "ylabel": quantity(measure), "title": runs.title}
    _draw_lines(lines, others, labels, path)


def draw_slowdown(runs: Table, along: str, mode: str, path: Path, full: str | None = None) -> None:
    """Draw Full over Solo makespan along a column, paired by seed, with intervals.

    Source: ``fig:ccr``.

    Raises:
        ScenarioError: A column is not varied, or matplotlib is not installed.
    """
    along, mode = column_of(runs, along), column_of(runs, mode)
    full = full_mode(runs, mode, SOLO, full)
    others = [each for each in parameters(runs) if each not in (along, mode)]

    def ratios(records: Sequence[Mapping[str, Any]]) -> list[float | None]:
        found = {(shown_value(r[mode]), r["seed"]): r["makespan_s"] for r in records}
        seeds = dict.fromkeys(r["seed"] for r in records)
        return [slowdown(found.get((full, seed)), found.get((SOLO, seed))) for seed in seeds]

    lines = [_line(group, others, along, ratios) for group in grouped(runs.to_dicts(), others)]
    ratio = f"makespan, {full} over {SOLO}"
    labels = {"xlabel": quantity(along), "ylabel": ratio, "title": runs.title}
    _draw_lines(lines, others, labels, path)


def draw_regret(runs: Table, policy: str, mode: str, path: Path, full: str | None = None) -> None:
    """Draw a bar per case: Full makespan of the Solo choice over the best; inversions in red.

    With several seeds a bar is their mean, with its interval, and red if any of them inverts.

    Source: ``fig:regret_scatter``.

    Raises:
        ScenarioError: A column is not varied, or matplotlib is not installed.
    """
    matrix = policies(runs, policy, mode, SOLO, full)
    heads = matrix.columns[: matrix.heads - 1]
    cases = grouped(matrix.to_dicts(), heads)
    means = [mean_interval(_plus_one(each["regret"] for each in case)) for case in cases]
    inversions = [sum(each["inversion"] is True for each in case) for case in cases]
    with figure_at(path, width_in=max(3.6, 1.2 + 0.32 * len(cases))) as figure:
        axes = figure.subplots()
        _draw_bars(axes, means, inversions)
        if len(cases) < len(matrix.rows):
            _count_inversions(axes, cases, means, inversions)
        labels = [_label(case[0], heads) for case in cases]
        axes.set_xticks(range(len(cases)), labels, rotation=90)
        axes.set(ylabel="Full makespan of the Solo\nchoice over the best", title=runs.title)
        axes.grid(visible=False, axis="x")
        axes.set_xlabel(" / ".join(map(_last_word, heads)))
        _name_colours(figure)


def _draw_bars(axes: Any, means: Sequence[MeanInterval], inversions: Sequence[int]) -> None:  # noqa: ANN401
    """Draw ratios as bars from 1, which is no regret, upwards."""
    places = range(len(means))
    heights = [_number(each.mean) - 1 for each in means]
    colours = [INVERTED if count else PLAIN for count in inversions]
    axes.bar(places, heights, bottom=1.0, color=colours, edgecolor=colours, width=0.75)
    tops = [_number(each.mean) for each in means]
    margins = _margins(means)
    if margins:
        axes.errorbar(places, tops, margins, fmt="none", ecolor="0.2", capsize=2)
    highest = max(filter(math.isfinite, (_number(_top(each)) for each in means)), default=1.0)
    axes.set_ylim(1 - 0.03 * (highest - 1), 1 + 1.12 * max(highest - 1, 0.01))


def _line(
    group: Sequence[Mapping[str, Any]],
    others: Sequence[str],
    along: str,
    values: Callable[[Sequence[Mapping[str, Any]]], list[float | None]],
) -> Line:
    name = ", ".join(shown_value(group[0][each]) for each in others)
    points = [(case[0][along], mean_interval(values(case))) for case in grouped(group, [along])]
    return Line(name, points)


def _draw_lines(
    lines: Sequence[Line], others: Sequence[str], labels: Mapping[str, str], path: Path
) -> None:
    """Draw lines whose names are the values of ``others``; ``labels`` names axes and figure."""
    has_legend = 1 < len(lines) <= MAX_LEGEND
    with figure_at(
        path, height_in=3.6 + 0.18 * math.ceil(len(lines) / LEGEND_COLUMNS) * has_legend
    ) as figure:
        axes = figure.subplots()
        for number, line in enumerate(lines):
            drawn = axes.errorbar(
                [_place(x) for x, _ in line.points],
                [_number(mean.mean) for _, mean in line.points],
                _margins([mean for _, mean in line.points]),
                label=line.name,
                **style(number),
            )
            if len(lines) == 1 and not all(isinstance(_place(x), float) for x, _ in line.points):
                drawn[0].set_linestyle("none")  # between names lies nothing
        places = dict.fromkeys(_place(x) for line in lines for x, _ in line.points)
        numbers = [place for place in places if isinstance(place, float)]
        if len(numbers) == len(places):
            _scale(axes, sorted(numbers))
        axes.set(**labels)
        if len(lines) > MAX_LEGEND:
            named = " / ".join(map(_last_word, others))
            axes.set_title(
                f"{labels['title']}\n{len(lines)} lines, one per {named}: too many to name"
            )
        if has_legend:
            names = ", ".join(map(_last_word, others))
            figure.legend(loc="outside lower center", ncols=LEGEND_COLUMNS, title=names)


def _scale(axes: Any, places: Sequence[float]) -> None:  # noqa: ANN401 - matplotlib is untyped
    """Mark the values that were run; on a logarithmic axis if they reach far."""
    if places[0] > 0 and places[-1] / places[0] >= WIDE:
        axes.set_xscale("log")
    axes.set_xticks(places, [f"{place:g}" for place in places])
    axes.set_xticks([], minor=True)


def _place(value: object) -> float | str:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return float(value) if is_number else shown_value(value)  # type: ignore[arg-type]


def _count_inversions(
    axes: Any,  # noqa: ANN401 - matplotlib is untyped
    cases: Sequence[Sequence[Mapping[str, Any]]],
    means: Sequence[MeanInterval],
    inversions: Sequence[int],
) -> None:
    """Write above the bars of several seeds how many of them invert."""
    for place, (case, mean, count) in enumerate(zip(cases, means, inversions, strict=True)):
        top = _top(mean)
        if len(case) > 1 and top is not None:
            text = f"{count}/{len(case)}"
            axes.annotate(
                text, (place, top), (0, 3), textcoords="offset points", ha="center", fontsize=7
            )


def _name_colours(figure: Any) -> None:  # noqa: ANN401 - matplotlib is untyped
    patches: Any = importlib.import_module("matplotlib.patches")
    names = {"rank inversion": INVERTED, "no inversion": PLAIN}
    handles = [patches.Patch(color=colour, label=name) for name, colour in names.items()]
    figure.legend(handles=handles, loc="outside lower center", ncols=2)


def _label(record: Mapping[str, Any], heads: Sequence[str]) -> str:
    return " / ".join(shown_value(record[each]) for each in heads) or "all"


def _last_word(column: str) -> str:
    return column.rpartition(".")[2]


def _plus_one(regrets: Any) -> list[float | None]:  # noqa: ANN401 - any iterable
    return [None if each is None else 1 + each for each in regrets]


def _number(value: float | None) -> float:
    return math.nan if value is None else value


def _margins(intervals: Sequence[MeanInterval]) -> list[float] | None:
    """Return half the widths of intervals; ``None`` where one seed gives none."""
    margins = [_margin(each) for each in intervals]
    return margins if any(margins) else None


def _top(interval: MeanInterval) -> float | None:
    return interval.mean if interval.high is None else interval.high


def _margin(interval: MeanInterval) -> float:
    """Return half the width of an interval, 0 without one."""
    return 0.0 if interval.high is None or interval.mean is None else interval.high - interval.mean
