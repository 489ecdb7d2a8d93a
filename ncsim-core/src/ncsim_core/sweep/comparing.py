"""Two columns of a study side by side: run by run, and over all pairs."""

from collections.abc import Mapping, Sequence
from typing import Any, Final, NamedTuple

from ncsim_core.errors import ScenarioError
from ncsim_core.metrics.statistics import (
    mean_interval,
    median,
    paired_differences,
    regret_of,
    slowdown,
    winner_set,
)
from ncsim_core.sweep.formatting import shown_value
from ncsim_core.sweep.plan import canonical
from ncsim_core.sweep.report import grouped
from ncsim_core.sweep.selecting import SEED, Selected
from ncsim_core.sweep.table import Table
from ncsim_core.units import s_from_us

NAMES: Final = ("first", "second")
MEASURED: Final = (
    *("first_s", "second_s", "difference_s", "ratio"),
    *("regret_first", "regret_second"),
)


class Pair(NamedTuple):
    """Two runs that agree in all columns that are not compared; makespans in seconds."""

    values: tuple[Any, ...]
    first_s: float | None
    second_s: float | None


def pairs_table(
    first: Sequence[Selected], second: Sequence[Selected], compared: Mapping[str, str]
) -> Table:
    """Return makespans of both, ratio, and the regret of taking either one.

    Args:
        first: Runs of the first column.
        second: Runs of the second.
        compared: Columns that tell them apart; the others pair them.

    Raises:
        ScenarioError: No run of one has its like in the other, or one has several.
    """
    columns = [column for column in first[0].values if column not in compared]
    for name, runs in zip(NAMES, (first, second), strict=True):
        _refuse_several(name, runs, columns, compared)
    likes = {_key(run, columns): run for run in second}
    pairs = [
        Pair(
            tuple(run.values[column] for column in columns),
            _makespan_s(run),
            _makespan_s(likes[_key(run, columns)]),
        )
        for run in first
        if _key(run, columns) in likes
    ]
    if not pairs:
        raise ScenarioError(f"no two runs agree in {', '.join(columns)}; nothing can be compared")
    rows = tuple(_row(pair) for pair in pairs)
    return Table((*columns, *MEASURED), rows, "makespan, second against first", heads=len(columns))


def _refuse_several(
    name: str, runs: Sequence[Selected], columns: Sequence[str], compared: Mapping[str, str]
) -> None:
    """Raise if two runs of one side differ in nothing by which they are paired.

    Raises:
        ScenarioError: They do; the message says what to name besides.
    """
    if len({_key(run, columns) for run in runs}) == len(runs):
        return
    still_open = {
        column: list(dict.fromkeys(shown_value(run.values[column]) for run in runs))
        for column in compared
    }
    listed = "; ".join(f"{c}={'|'.join(there)}" for c, there in still_open.items() if there[1:])
    raise ScenarioError(
        f"the {name} of the two means several runs for each of the other; say which: {listed}"
    )


def pairs_cases(table: Table, confidence: float = 0.95) -> Table:
    """Return a ``pairs_table`` over its seeds: means, intervals of differences and ratios."""
    columns = [column for column in table.columns[: table.heads] if column != SEED]
    rows = []
    for case in grouped(table.to_dicts(), columns):
        values = {name: [pair[name] for pair in case] for name in MEASURED}
        means = {name: mean_interval(each, confidence) for name, each in values.items()}
        difference, ratio = means["difference_s"], means["ratio"]
        rows.append(
            (
                *(case[0][column] for column in columns),
                *(means["first_s"].mean, means["second_s"].mean),
                *(difference.mean, difference.low, difference.high),
                *(ratio.mean, ratio.low, ratio.high),
                *(means["regret_first"].mean, means["regret_second"].mean),
                *(difference.count, difference.left_out),
            )
        )
    names = (
        *("first_s", "second_s", "difference_s", "low", "high", "ratio", "ratio_low"),
        *("ratio_high", "regret_first", "regret_second", "pairs", "left_out"),
    )
    title = f"{table.title}; means over seeds, {confidence:.0%} intervals"
    return Table((*columns, *names), tuple(rows), title, heads=len(columns))


def pairs_totals(table: Table, confidence: float = 0.95) -> Table:
    """Return means with Student-t intervals over the rows of a ``pairs_table``."""
    columns = table.to_columns()
    rows = []
    for name in MEASURED:
        mean, middle = mean_interval(columns[name], confidence), median(columns[name])
        cells = (mean.mean, mean.low, mean.high, middle.median, mean.count, mean.left_out)
        rows.append((name, *cells))
    names = ("what", "mean", "low", "high", "median", "pairs", "left_out")
    title = f"over all pairs, {confidence:.0%} intervals; {_who_is_better(columns)}"
    return Table(names, tuple(rows), title, heads=1)


def _row(pair: Pair) -> tuple[Any, ...]:
    makespans_s = dict(zip(NAMES, pair[1:], strict=True))
    difference_s = paired_differences([pair.first_s], [pair.second_s])[0]
    regrets = (regret_of(name, makespans_s) for name in NAMES)
    ratio = slowdown(pair.second_s, pair.first_s)
    return (*pair.values, pair.first_s, pair.second_s, difference_s, ratio, *regrets)


def _who_is_better(columns: Mapping[str, Sequence[float | None]]) -> str:
    winners = [
        winner_set(dict(zip(NAMES, both, strict=True)))
        for both in zip(columns["first_s"], columns["second_s"], strict=True)
    ]
    counts = [sum(each == (name,) for each in winners) for name in NAMES]
    ties = sum(each == NAMES for each in winners)
    return f"first better {counts[0]}, second better {counts[1]}, ties {ties}"


def _key(run: Selected, columns: Sequence[str]) -> str:
    return canonical([run.values[column] for column in columns])


def _makespan_s(run: Selected) -> float | None:
    us = None if run.result is None else run.result.makespan_us
    return None if us is None else s_from_us(us)
