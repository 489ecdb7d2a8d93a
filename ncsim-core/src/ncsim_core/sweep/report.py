"""What the runs of a study amount to; all definitions are those of ``metrics.statistics``.

Runs that did not complete enter no mean; every table says how many there were.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
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
from ncsim_core.sweep.plan import canonical
from ncsim_core.sweep.table import MEASURES, Table, shown_value
from ncsim_core.sweep.where import spellings

SOLO: Final = "none"


def summary(runs: Table, measure: str = "makespan_s", confidence: float = 0.95) -> Table:
    """Return mean with Student-t interval and median over the seeds of each combination."""
    columns = parameters(runs)
    rows = []
    for _, group in _grouped(runs, columns):
        values = [record[measure] for record in group]
        interval, middle = mean_interval(values, confidence), median(values)
        head = [group[0][column] for column in columns]
        span = (interval.mean, interval.low, interval.high)
        rows.append((*head, *span, middle.median, interval.count, interval.left_out))
    names = (f"mean_{measure}", "low", "high", f"median_{measure}", "runs", "left_out")
    return Table((*columns, *names), tuple(rows), f"{runs.title}: {measure}, {confidence:.0%}")


def policies(runs: Table, policy: str, mode: str, solo: str = SOLO) -> Table:
    """Return for each other combination and seed what choosing a policy by Solo costs in Full.

    Ratios to the best policy in Full (``tab:winner_matrix``), the Solo and Full winners, rank
    inversion and regret. The order of preference among tied policies is that of the file.

    Args:
        runs: All runs.
        policy: The column of the policies, such as ``scheduler``.
        mode: The column that tells Solo from Full, with two values.
        solo: The value that means Solo.

    Raises:
        ScenarioError: A column is not varied, or ``mode`` has other values than these two.
    """
    policy, mode = column_of(runs, policy), column_of(runs, mode)
    names = _values(runs, policy)
    modes = _values(runs, mode)
    if len(modes) != 2 or solo not in modes:  # noqa: PLR2004 - Solo and Full
        raise ScenarioError(f"{mode!r} needs two values, one of them {solo!r}; it has {modes}")
    full = next(each for each in modes if each != solo)
    columns = [*(each for each in parameters(runs) if each not in (policy, mode)), "seed"]
    rows = []
    for _, group in _grouped(runs, columns):
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
    found = ("solo_winners", "full_winners", "inversion", "regret", "slowdown")
    return Table((*columns, *names, *found), tuple(rows), f"{runs.title}: {policy} by {mode}")


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
        ("maximum regret", max((each for each in regrets if each is not None), default=None)),
        ("left out", interval.left_out),
    ]
    return Table(("what", "value"), tuple(rows), f"{matrix.title}, totals")


def paired(runs: Table, axis: str, measure: str = "makespan_s") -> Table:
    """Return differences to the first value of a column, seed by seed, with intervals.

    Raises:
        ScenarioError: The column is not varied.
    """
    axis = column_of(runs, axis)
    first, *others = _values(runs, axis)
    columns = [each for each in parameters(runs) if each != axis]
    rows = []
    for _, group in _grouped(runs, columns):
        found = {(shown_value(r[axis]), r["seed"]): r[measure] for r in group}
        seeds = list(dict.fromkeys(r["seed"] for r in group))
        for other in others:
            one, two = ([found.get((name, seed)) for seed in seeds] for name in (first, other))
            interval = mean_interval(paired_differences(one, two))
            head = [group[0][column] for column in columns]
            rows.append((*head, f"{other} - {first}", *_interval_cells(interval)))
    names = ("difference", f"mean_{measure}", "low", "high", "pairs", "left_out")
    return Table((*columns, *names), tuple(rows), f"{runs.title}: {axis}, paired")


def _interval_cells(interval: Any) -> tuple[Any, ...]:  # noqa: ANN401 - a MeanInterval
    return (interval.mean, interval.low, interval.high, interval.count, interval.left_out)


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
        raise ScenarioError(f"{name!r} is not varied; varied are {', '.join(parameters(runs))}")
    return names[name]


def _values(runs: Table, column: str) -> list[str]:
    index = runs.columns.index(column)
    return list(dict.fromkeys(shown_value(row[index]) for row in runs.rows))


def _grouped(runs: Table, columns: Sequence[str]) -> Iterator[tuple[str, list[Mapping[str, Any]]]]:
    """Yield the runs that agree in some columns, in the order of their first."""
    groups: dict[str, list[Mapping[str, Any]]] = {}
    records: Iterable[Mapping[str, Any]] = runs.to_dicts()
    for record in records:
        groups.setdefault(canonical([record[each] for each in columns]), []).append(record)
    yield from groups.items()
