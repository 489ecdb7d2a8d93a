"""What the runs of a study amount to; all definitions are those of ``metrics.statistics``.

Runs that did not complete enter no mean; every table says how many there were.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from ncsim_core.errors import ScenarioError
from ncsim_core.metrics.statistics import (
    is_rank_inversion,
    mean_interval,
    median,
    paired_differences,
    ratios_to_best,
    regret,
    slowdown,
    solo_choice,
    winner_set,
)
from ncsim_core.scenario.wording import did_you_mean
from ncsim_core.sweep.formatting import shown_value
from ncsim_core.sweep.plan import canonical
from ncsim_core.sweep.table import MEASURES, NUMBERS, Table
from ncsim_core.sweep.where import spellings

SOLO: Final = "none"
FOUND: Final = ("solo_winners", "full_winners", "inversion", "regret", "slowdown")


def summary(runs: Table, measure: str = "makespan_s", confidence: float = 0.95) -> Table:
    """Return mean with Student-t interval and median over the seeds of each combination.

    Raises:
        ScenarioError: There is no such measure.
    """
    check_measure(measure)
    return means(runs, parameters(runs), measure, confidence)


def means(runs: Table, by: Sequence[str], measure: str, confidence: float = 0.95) -> Table:
    """Return mean with Student-t interval and median over all rows that agree in some columns."""
    columns = list(by)
    rows = []
    for group in grouped(runs.to_dicts(), columns):
        values = [record[measure] for record in group]
        interval, middle = mean_interval(values, confidence), median(values)
        head = [group[0][column] for column in columns]
        span = (interval.mean, interval.low, interval.high)
        rows.append((*head, *span, middle.median, interval.count, interval.left_out))
    names = (f"mean_{measure}", "low", "high", f"median_{measure}", "runs", "left_out")
    title = f"{runs.title}: {measure}, {confidence:.0%} intervals over seeds"
    return Table((*columns, *names), tuple(rows), title, heads=len(columns))


def policies(
    runs: Table, policy: str, mode: str, solo: str = SOLO, full: str | None = None
) -> Table:
    """Return for each other combination and seed what choosing a policy by Solo costs in Full.

    Ratios to the best policy in Full (``tab:winner_matrix``), the Solo and Full winners, rank
    inversion and regret. The order of preference among tied policies is that of the file.

    Args:
        runs: All runs.
        policy: The column of the policies, such as ``scheduler``.
        mode: The column that tells Solo from Full.
        solo: The value that means Solo.
        full: The value that means Full; may be left out if there are two.

    Raises:
        ScenarioError: A column is not varied, or ``mode`` has no such values.
    """
    policy, mode = column_of(runs, policy), column_of(runs, mode)
    names = values_of(runs, policy)
    full = full_mode(runs, mode, solo, full)
    columns = [*(each for each in parameters(runs) if each not in (policy, mode)), "seed"]
    rows = []
    for group in grouped(runs.to_dicts(), columns):
        makespans = {(shown_value(r[mode]), shown_value(r[policy])): r["makespan_s"] for r in group}
        solo_s = {name: makespans.get((solo, name)) for name in names}
        full_s = {name: makespans.get((full, name)) for name in names}
        ratios = ratios_to_best(full_s)
        choice = solo_choice(solo_s, names)
        rows.append(
            (
                *(group[0][column] for column in columns),
                *(ratios[name] for name in names),
                "/".join(winner_set(solo_s)),
                "/".join(winner_set(full_s)),
                is_rank_inversion(solo_s, full_s),
                regret(solo_s, full_s, names),
                slowdown(full_s[choice], solo_s[choice]) if choice else None,
            )
        )
    title = f"{runs.title}: {policy}, {full} over the best; chosen by {solo}"
    return Table((*columns, *names, *FOUND), tuple(rows), title, heads=len(columns))


def policy_cases(matrix: Table, confidence: float = 0.95) -> Table:
    """Return a ``policies`` table over its seeds: inversions, regret, slowdown of the choice."""
    columns = list(matrix.columns[: matrix.heads - 1])
    rows = []
    for group in grouped(matrix.to_dicts(), columns):
        regrets = [each["regret"] for each in group]
        mean, slow = (
            mean_interval([each[name] for each in group], confidence)
            for name in ("regret", "slowdown")
        )
        rows.append(
            (
                *(group[0][column] for column in columns),
                len(group),
                sum(each["inversion"] is True for each in group),
                *(mean.mean, mean.low, mean.high),
                *(median(regrets).median, _largest(regrets)),
                *(slow.mean, slow.low, slow.high, mean.left_out),
            )
        )
    names = (
        *("cases", "inversions", "mean_regret", "regret_low", "regret_high", "median_regret"),
        *("largest_regret", "mean_slowdown", "slowdown_low", "slowdown_high", "left_out"),
    )
    title = f"{matrix.title}, {confidence:.0%} intervals over seeds"
    return Table((*columns, *names), tuple(rows), title, heads=len(columns))


def policy_totals(matrix: Table) -> Table:
    """Return inversion rate and mean, median and maximum regret of a ``policies`` table."""
    records = matrix.to_dicts()
    inversions = [r["inversion"] for r in records if r["inversion"] is not None]
    regrets = [r["regret"] for r in records]
    interval = mean_interval(regrets)
    rows = [
        ("cases", len(records)),
        ("rank inversions", sum(inversions)),
        ("inversion rate", sum(inversions) / len(inversions) if inversions else None),
        ("mean regret", interval.mean),
        ("mean regret, low", interval.low),
        ("mean regret, high", interval.high),
        ("median regret", median(regrets).median),
        ("maximum regret", _largest(regrets)),
        ("left out", interval.left_out),
    ]
    return Table(("what", "value"), tuple(rows), f"{matrix.title}, totals", heads=1)


def paired(runs: Table, axis: str, measure: str = "makespan_s", confidence: float = 0.95) -> Table:
    """Return differences to the first value of a column, seed by seed, with intervals.

    Raises:
        ScenarioError: The column is not varied, or there is no such measure.
    """
    check_measure(measure)
    axis = column_of(runs, axis)
    first, *others = values_of(runs, axis)
    columns = [each for each in parameters(runs) if each != axis]
    rows = []
    for group in grouped(runs.to_dicts(), columns):
        found = {(shown_value(r[axis]), r["seed"]): r[measure] for r in group}
        for other in others:
            seeds = [s for name, s in found if name == other and (first, s) in found]
            one, two = ([found[name, seed] for seed in seeds] for name in (first, other))
            mean = mean_interval(paired_differences(one, two), confidence)
            head = [group[0][column] for column in columns]
            cells = (mean.mean, mean.low, mean.high, mean.count, mean.left_out)
            if seeds:  # a condition may leave one of the two out
                rows.append((*head, f"{other} - {first}", *cells))
    names = ("difference", "mean_difference", "low", "high", "pairs", "left_out")
    title = f"{runs.title}: {measure} along {axis}, paired by seed, {confidence:.0%} intervals"
    return Table((*columns, *names), tuple(rows), title, heads=len(columns))


def parameters(runs: Table) -> list[str]:
    """Return the columns of a table of runs that were varied."""
    return [each for each in runs.columns if each not in (*MEASURES, "seed")]


def column_of(runs: Table, name: str) -> str:
    """Return the varied column that a name means: the whole path, or its unique end.

    Raises:
        ScenarioError: There is none.
    """
    names = spellings(parameters(runs))
    if name not in names:
        varied = ", ".join(parameters(runs)) or "nothing but seeds"
        raise ScenarioError(f"{name!r} is not varied in this study; varied: {varied}")
    return names[name]


def values_of(runs: Table, column: str) -> list[str]:
    """Return the values of a column as text, in the order of the file."""
    index = runs.columns.index(column)
    return list(dict.fromkeys(shown_value(row[index]) for row in runs.rows))


def grouped(
    records: Iterable[Mapping[str, Any]], columns: Sequence[str]
) -> list[list[Mapping[str, Any]]]:
    """Return the records that agree in some columns, in the order of their first."""
    groups: dict[str, list[Mapping[str, Any]]] = {}
    for record in records:
        groups.setdefault(canonical([record[each] for each in columns]), []).append(record)
    return list(groups.values())


def check_measure(measure: str) -> None:
    """Raise if something is no number that is kept of every run.

    Raises:
        ScenarioError: It is none.
    """
    if measure not in NUMBERS:
        meant = did_you_mean(measure, NUMBERS)
        hint = f"did you mean {meant!r}? " if meant else ""
        raise ScenarioError(f"no measure {measure!r}; {hint}there are {', '.join(NUMBERS)}")


def full_mode(runs: Table, mode: str, solo: str = SOLO, full: str | None = None) -> str:
    """Return which value of a column means Full: ``full``, or the only one beside Solo.

    Raises:
        ScenarioError: There is no such value, or there are several.
    """
    modes = values_of(runs, mode)
    others = [each for each in modes if each != solo]
    if solo not in modes or not others:
        raise ScenarioError(
            f"{mode!r} needs {solo!r} for Solo and another value; it has {', '.join(modes)}"
        )
    if full is None and len(others) > 1:
        raise ScenarioError(f"{mode!r} has {', '.join(modes)}; say which means Full (--full)")
    if full not in (None, *others):
        raise ScenarioError(f"{mode!r} has no {full!r} beside {solo!r}; it has {', '.join(modes)}")
    return full or others[0]


def _largest(values: Sequence[float | None]) -> float | None:
    return max((each for each in values if each is not None), default=None)
