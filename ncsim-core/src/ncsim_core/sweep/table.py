"""Tables of runs and of what they amount to, and how they are written down."""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ncsim_core.errors import ScenarioError
from ncsim_core.sweep.plan import SweepPlan, canonical
from ncsim_core.sweep.store import Store
from ncsim_core.sweep.worker import ResultRow
from ncsim_core.units import s_from_us

if TYPE_CHECKING:
    import pandas as pd

MEASURES = (
    *("status", "makespan_s", "ended_s", "events", "transfers"),
    *("remote_MB", "route_work_MB_hops", "wall_s", "error"),
)


@dataclass(frozen=True)
class Table:
    """Rows under named columns.

    Args:
        columns: Names, the last word of each a unit where it has one.
        rows: Values; ``None`` where there is none.
        title: What it shows.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]
    title: str = ""

    def to_dicts(self) -> list[dict[str, Any]]:
        """Return one mapping per row."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]

    def to_columns(self) -> dict[str, list[Any]]:
        """Return the values by column, as ``polars.DataFrame`` and ``pandas.DataFrame`` take it."""
        return {name: [row[i] for row in self.rows] for i, name in enumerate(self.columns)}

    def to_pandas(self) -> "pd.DataFrame":
        """Return a pandas DataFrame.

        Raises:
            ImportError: pandas is not installed.
        """
        import pandas as pd

        return pd.DataFrame(self.to_columns())

    def to_markdown(self) -> str:
        """Return a Markdown table."""
        lines = [self.columns, ["---"] * len(self.columns), *map(_texts, self.rows)]
        return "\n".join(f"| {' | '.join(line)} |" for line in lines)

    def to_latex(self) -> str:
        """Return a LaTeX table in the style of booktabs."""
        marks = "".join("r" if _is_numeric(self.rows, i) else "l" for i in range(len(self.columns)))
        lines = [" & ".join(map(_escaped, each)) + r" \\" for each in map(_texts, self.rows)]
        head = " & ".join(map(_escaped, self.columns)) + r" \\"
        return "\n".join(
            [
                f"\\begin{{tabular}}{{{marks}}}",
                r"\toprule",
                head,
                r"\midrule",
                *lines,
                r"\bottomrule",
                r"\end{tabular}",
            ]
        )

    def to_csv(self) -> str:
        """Return comma-separated values; numbers at full precision, nothing for ``None``."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows([_plain(value) for value in row] for row in self.rows)
        return text.getvalue()

    def write_parquet(self, path: Path) -> None:
        """Write a Parquet file.

        Raises:
            ScenarioError: pyarrow is not installed.
        """
        try:
            import pyarrow as pa  # type: ignore[import-untyped,unused-ignore]
            import pyarrow.parquet as pq  # type: ignore[import-untyped,unused-ignore]
        except ImportError:
            raise ScenarioError("Parquet needs the package pyarrow: pip install pyarrow") from None
        data = {name: [_plain(each) for each in v] for name, v in self.to_columns().items()}
        pq.write_table(pa.table(data), path)


def record_of(
    plan: SweepPlan, values: Sequence[Any], seed: int, row: ResultRow | None
) -> dict[str, Any]:
    """Return one run as a mapping; a run that is still to be done has status ``None``."""
    head = {**dict(zip(plan.columns, values, strict=True)), "seed": seed}
    if row is None:
        return head | dict.fromkeys(MEASURES)
    measured = row._asdict() | {
        "makespan_s": None if row.makespan_us is None else s_from_us(row.makespan_us),
        "ended_s": None if row.ended_us is None else s_from_us(row.ended_us),
    }
    return head | {name: measured[name] for name in MEASURES}


def table_of(store: Store) -> Table:
    """Return all runs of a study's current sweep, in the order of its file."""
    plan, _ = store.current()
    columns = (*plan.columns, "seed", *MEASURES)
    rows = (tuple(record_of(plan, *each).values()) for each in store.rows())
    return Table(columns, tuple(rows), plan.name)


def shown_value(value: object) -> str:
    """Return a value as a table shows it."""
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.6g}" if abs(value) < 1 else f"{value:.4f}".rstrip("0").rstrip(".")
    if isinstance(value, dict):
        return str(value.get("type", canonical(value)))
    return canonical(value) if isinstance(value, list) else str(value)


def _texts(row: Sequence[Any]) -> list[str]:
    return [shown_value(value) for value in row]


def _plain(value: Any) -> Any:  # noqa: ANN401 - plain data
    return canonical(value) if isinstance(value, dict | list) else value


def _is_numeric(rows: Sequence[Sequence[Any]], column: int) -> bool:
    return all(isinstance(row[column], int | float | None) for row in rows)


def _escaped(text: str) -> str:
    return "".join(f"\\{each}" if each in "_%&#$" else each for each in text)
