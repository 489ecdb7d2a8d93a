"""Tables of runs and of what they amount to, and how they are written down."""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ncsim_core.errors import ScenarioError
from ncsim_core.sweep.formatting import (
    DIGITS,
    cells,
    escaped_for_latex,
    escaped_for_markdown,
    is_numeric,
    quantity,
)
from ncsim_core.sweep.plan import SweepPlan, canonical
from ncsim_core.sweep.store import Store
from ncsim_core.sweep.worker import ResultRow
from ncsim_core.trace.files import appearing
from ncsim_core.units import s_from_us

if TYPE_CHECKING:
    import pandas as pd

MEASURES: Final = (
    *("status", "makespan_s", "ended_s", "events", "transfers"),
    *("remote_MB", "route_work_MB_hops", "wall_s", "error"),
)
"""What is kept of every run."""

NUMBERS: Final = tuple(each for each in MEASURES if each not in ("status", "error"))
"""Those that can be averaged."""


@dataclass(frozen=True)
class Table:
    """Rows under named columns.

    Args:
        columns: Names, the last word of each a unit where it has one.
        rows: Values; ``None`` where there is none.
        title: What it shows.
        heads: How many columns, from the first, say what a row is about.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]
    title: str = ""
    heads: int = 0

    def to_dicts(self) -> list[dict[str, Any]]:
        """Return one mapping per row."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]

    def to_columns(self) -> dict[str, list[Any]]:
        """Return the values by column, each of one type.

        ``polars.DataFrame``, ``pandas.DataFrame`` and ``pyarrow.table`` take it as it is.
        """
        return {
            name: _of_one_type([row[i] for row in self.rows]) for i, name in enumerate(self.columns)
        }

    def to_pandas(self) -> "pd.DataFrame":
        """Return a pandas DataFrame.

        Raises:
            ImportError: pandas is not installed.
        """
        import pandas as pd

        return pd.DataFrame(self.to_columns())

    def to_markdown(self, digits: int = DIGITS) -> str:
        """Return a Markdown table, its title above it."""
        head, *body = (
            map(escaped_for_markdown, row)
            for row in (self.columns, *cells(self.rows, self.heads, digits))
        )
        rule = ["---:" if is_right else "---" for is_right in self.numeric]
        lines = [f"| {' | '.join(line)} |" for line in (head, rule, *body)]
        return "\n".join([f"**{self.title}**", "", *lines] if self.title else lines)

    def to_latex(self, digits: int = DIGITS) -> str:
        """Return a LaTeX table for the package booktabs, its title as a comment above it."""
        marks = "".join("r" if is_right else "l" for is_right in self.numeric)
        lines = [
            " & ".join(map(escaped_for_latex, row)) + r" \\"
            for row in (map(quantity, self.columns), *cells(self.rows, self.heads, digits))
        ]
        return "\n".join(
            [
                *([f"% {' '.join(self.title.split())}"] if self.title else []),
                r"% \usepackage{booktabs}",
                f"\\begin{{tabular}}{{{marks}}}",
                r"\toprule",
                lines[0],
                r"\midrule",
                *lines[1:],
                r"\bottomrule",
                r"\end{tabular}",
            ]
        )

    @property
    def numeric(self) -> list[bool]:
        """Return which columns are numbers, and so stand to the right."""
        return [is_numeric(self.rows, index) for index in range(len(self.columns))]

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
        path.parent.mkdir(parents=True, exist_ok=True)
        with appearing(path) as place:
            pq.write_table(pa.table(self.to_columns()), place)


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
    return Table(columns, tuple(rows), plan.name, heads=len(plan.columns) + 1)


def _plain(value: Any) -> Any:  # noqa: ANN401 - plain data
    return canonical(value) if isinstance(value, dict | list | tuple) else value


def _of_one_type(values: Sequence[Any]) -> list[Any]:
    """Return a column as one type.

    Lists and mappings become JSON, whole numbers beside others fractions, and everything text
    where numbers and text meet.
    """
    plain = [_plain(value) for value in values]
    kinds = {type(value) for value in plain if value is not None}
    if kinds == {int, float}:
        return [None if value is None else float(value) for value in plain]
    if len(kinds) > 1:
        return [None if value is None else str(value) for value in plain]
    return plain
