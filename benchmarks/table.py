"""Rows of measurements, and how they are printed; ``make bench`` collects them."""

import gc
import statistics
import time
from collections.abc import Callable, Iterable
from typing import NamedTuple


class Row(NamedTuple):
    """One measurement.

    Args:
        name: What was done.
        target: CPU seconds, or another number with its unit in the name; ``None``: no target.
        measured: In the unit of the target, a median.
        note: What else to know, such as what a peer took for the same.
    """

    name: str
    target: float | None
    measured: float
    note: str = ""

    @property
    def verdict(self) -> str:
        """Return whether the target is met."""
        if self.target is None:
            return ""
        return "met" if self.measured <= self.target else "missed"


HEADINGS = ("what", "target", "measured", "ratio", "verdict", "note")


def cpu_median_s(work: Callable[[], object], repeats: int = 5) -> float:
    """Return the median CPU time (s) of some work in this process, garbage collected before."""
    spent = []
    for _ in range(repeats):
        gc.collect()
        started_s = time.process_time()
        work()
        spent.append(time.process_time() - started_s)
    return statistics.median(spent)


def markdown(rows: Iterable[Row]) -> str:
    """Return a Markdown table; seconds have three significant digits."""
    lines = [
        "| " + " | ".join(HEADINGS) + " |",
        "|---|---:|---:|---:|---|---|",
    ]
    lines += ["| " + " | ".join(_cells(row)) + " |" for row in rows]
    return "\n".join(lines)


def print_table(rows: Iterable[Row]) -> None:
    """Print a table."""
    print(markdown(rows))


def _cells(row: Row) -> tuple[str, ...]:
    if row.target is None:
        return row.name, "", f"{row.measured:.3g}", "", "", row.note
    ratio = f"{row.measured / row.target:.2f}"
    return row.name, f"{row.target:g}", f"{row.measured:.3g}", ratio, row.verdict, row.note
