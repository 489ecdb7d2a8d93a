"""A study ready for JSON; every number comes from ``ncsim_core.sweep.report``."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Final

from ncsim_core.errors import ScenarioError
from ncsim_core.metrics.statistics import slowdown
from ncsim_core.sweep.formatting import shown_value
from ncsim_core.sweep.report import (
    SOLO,
    column_of,
    full_mode,
    grouped,
    means,
    parameters,
    policies,
    policy_totals,
    values_of,
)
from ncsim_core.sweep.store import STORE_NAME, Store
from ncsim_core.sweep.table import Table, table_of

MAX_ROWS: Final = 20_000
"""Runs that are listed one by one; means are always over all."""
MEASURE: Final = "makespan_s"


def is_study(path: Path) -> bool:
    """Return whether a path is the folder of a study."""
    return (path / STORE_NAME).is_file()


def study_document(
    folder: Path,
    policy: str = "scheduler",
    mode: str = "interference",
    where: Mapping[str, str] | None = None,
) -> dict[str, object]:
    """Return what the page needs of a study.

    Args:
        folder: Of the study.
        policy: The column of the policies that are compared, or the end of its path.
        mode: The column that tells Solo from Full.
        where: By column, the value as shown that a run must have to be counted.

    Raises:
        ScenarioError: There is no study, or ``where`` names what is not varied.
    """
    with Store(folder, must_exist=True) as store:
        _, planned = store.current()
        counts = store.counts()
        every = table_of(store)
    numbers, runs = _selected(every, where or {})
    tables = _tables(runs, policy, mode)
    left_out = max(0, len(runs.rows) - MAX_ROWS)
    notes = [tables["note"], f"{left_out} runs are not listed one by one." if left_out else ""]
    return {
        "name": every.title,
        "planned": planned,
        "counts": counts,
        "factors": [_factor(every, name) for name in parameters(every)],
        "numbers": numbers[:MAX_ROWS],
        "runs": _table(replace(runs, rows=runs.rows[:MAX_ROWS])),
        **tables,
        "note": " ".join(str(note) for note in notes if note),
    }


def _tables(runs: Table, policy: str, mode: str) -> dict[str, object]:
    """Return what the runs amount to, and why some of it is missing."""
    matrix, roles, note = _matrix(runs, policy, mode)
    slowdowns = _slowdowns(runs, mode)
    return {
        "roles": roles,
        "note": note,
        "winners": None if matrix is None else _table(matrix),
        "totals": None if matrix is None else _table(policy_totals(matrix)),
        "groups": [
            *_means(runs, MEASURE),
            *([] if slowdowns is None else _means(slowdowns, "slowdown")),
            *([] if matrix is None else _means(_regrets(matrix), "regret")),
        ],
    }


def _selected(runs: Table, where: Mapping[str, str]) -> tuple[list[int], Table]:
    """Return the runs that meet conditions, and their places among all."""
    wanted = {column_of(runs, name): value for name, value in where.items()}
    places = [(runs.columns.index(name), value) for name, value in wanted.items()]
    numbers = [
        number
        for number, row in enumerate(runs.rows)
        if all(shown_value(row[at]) == value for at, value in places)
    ]
    return numbers, replace(runs, rows=tuple(runs.rows[number] for number in numbers))


def _matrix(runs: Table, policy: str, mode: str) -> tuple[Table | None, dict[str, str] | None, str]:
    """Return winners and regret with the columns they are of, or why there are none."""
    try:
        matrix = policies(runs, policy, mode)
        policy, mode = column_of(runs, policy), column_of(runs, mode)
    except ScenarioError as error:
        return None, None, f"No winners and regret: {error}."
    full = full_mode(runs, mode, SOLO)
    return matrix, {"policy": policy, "mode": mode, "solo": SOLO, "full": full}, ""


def _slowdowns(runs: Table, mode: str) -> Table | None:
    """Return Full over Solo of each combination and seed; ``None`` if these are not two modes."""
    try:
        mode = column_of(runs, mode)
        full = full_mode(runs, mode, SOLO)
    except ScenarioError:
        return None
    columns = [*(name for name in parameters(runs) if name != mode), "seed"]
    rows = []
    for group in grouped(runs.to_dicts(), columns):
        found = {shown_value(record[mode]): record[MEASURE] for record in group}
        ratio = slowdown(found.get(full), found.get(SOLO))
        rows.append((*(group[0][name] for name in columns), _finite(ratio)))
    return Table((*columns, "slowdown"), tuple(rows), runs.title, heads=len(columns))


def _regrets(matrix: Table) -> Table:
    """Return the regret of each case of a table of policies."""
    columns = matrix.columns[: matrix.heads]
    rows = tuple(
        (*row[: matrix.heads], _finite(row[matrix.columns.index("regret")])) for row in matrix.rows
    )
    return Table((*columns, "regret"), rows, matrix.title, heads=matrix.heads)


def _means(table: Table, measure: str) -> Iterator[dict[str, object]]:
    """Yield means over all rows that agree in one factor, and in each pair of factors."""
    names = [name for name in table.columns[: table.heads] if name != "seed"]
    pairs = combinations(names, 2) if len(table.rows) <= MAX_ROWS else ()
    for by in [*((name,) for name in names), *pairs]:
        found = means(table, by, measure)
        columns = (*by, "mean", "low", "high", "median", "runs", "left_out")
        title = f"{table.title}: {measure} by {' and '.join(by)}"
        entry = {"by": list(by), "measure": measure}
        yield entry | {"table": _table(replace(found, columns=columns, title=title))}


def _factor(runs: Table, name: str) -> dict[str, object]:
    return {"name": name, "values": values_of(runs, name)}


def _table(table: Table) -> dict[str, object]:
    rows = [[_cell(value) for value in row] for row in table.rows]
    return {"title": table.title, "columns": list(table.columns), "rows": rows}


def _cell(value: object) -> object:
    return shown_value(value) if isinstance(value, dict | list) else _finite(value)


def _finite(value: object) -> object:
    """Return a value that JSON has: a ratio to nothing becomes ``None``."""
    return None if isinstance(value, float) and not math.isfinite(value) else value
