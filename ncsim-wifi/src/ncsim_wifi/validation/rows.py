"""One line of the validation: what was expected, what came out, and what that means."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from pathlib import Path
from typing import Any, Literal, TypeAlias

from ncsim_core.cli.tables import aligned

Stage: TypeAlias = Literal["internal", "literature", "packet"]
Relation: TypeAlias = Literal["=", "<="]
Verdict: TypeAlias = Literal["pass", "FAIL", "differs"]

DATA = Path(__file__).parent / "data"


@dataclass(frozen=True)
class Row:
    """One comparison.

    Args:
        stage: One of the three stages.
        experiment: Which experiment of the paper.
        case: Its setting.
        quantity: What is compared, with its unit.
        expected: The number it should be, or should not exceed.
        source: Where that number is from.
        measured: What came out.
        tolerance: How far the two may be apart. ``None`` marks a comparison with packets: it
            is shown, not judged, for the model has errors, and what the paper states about
            them is judged in rows of its own.
        relation: Whether ``measured`` should be as expected, or at most that.
        is_detail: Whether a table for people leaves it out, unless it fails.
    """

    stage: Stage
    experiment: str
    case: str
    quantity: str
    expected: float
    source: str
    measured: float
    tolerance: float | None
    relation: Relation = "="
    is_detail: bool = False

    @property
    def error(self) -> float:
        """Return by how much measured differs from, or exceeds, expected."""
        if self.measured == self.expected:  # infinite or not
            return 0.0
        difference = self.measured - self.expected
        if self.relation == "<=":
            return max(difference, 0.0)  # in this order, in which NaN stays NaN
        return abs(difference)

    @property
    def relative_error(self) -> float | None:
        """Return the error over the expected number, ``None`` if that is 0 or infinite."""
        if self.expected == 0.0 or math.isinf(self.expected):
            return None
        return self.error / abs(self.expected)

    @property
    def verdict(self) -> Verdict:
        """Return what the comparison says; ``differs`` where the model is known to err."""
        if self.error == 0.0:
            return "pass"
        if self.tolerance is None:
            return "differs"
        return "pass" if self.error <= self.tolerance else "FAIL"

    def to_dict(self) -> dict[str, object]:
        """Return the row as plain data; what has no finite number is ``None``."""
        derived = {
            "error": self.error,
            "relative_error": self.relative_error,
            "verdict": self.verdict,
        }
        return {
            key: None if isinstance(value, float) and not math.isfinite(value) else value
            for key, value in (asdict(self) | derived).items()
        }


def half_a_digit(decimals: int) -> float:
    """Return how far a number may be from one printed with so many decimals."""
    return 0.5 * 10.0**-decimals * (1.0 + 1e-9)


def read_data(name: str) -> Mapping[str, Any]:
    """Return one of the package's files of published numbers."""
    data: Mapping[str, Any] = json.loads((DATA / f"{name}.json").read_text("utf-8"))
    return data


HEADINGS = ("case", "quantity", "expected", "measured", "error", "relative", "allowed")
LEAST_PERCENT_SHOWN = 1e-4
NUMBERS = slice(2, 7)  # columns set to the right


def table_text(rows: Iterable[Row]) -> str:
    """Return rows as an aligned table with a heading per experiment."""
    listed = list(rows)
    cells = [_cells(row) for row in listed]
    widths = [max(map(len, column)) for column in zip(HEADINGS, *cells, strict=True)]
    head, *lines = aligned(
        [
            (*_justified(each, widths), row.verdict, row.source)
            for each, row in zip(cells, listed, strict=True)
        ],
        (*_justified(HEADINGS, widths), "verdict", "source"),
    ).splitlines()
    text = ["  " + head]
    for name, group in groupby(
        zip(listed, lines, strict=True), key=lambda pair: pair[0].experiment
    ):
        text += [name, *("  " + line for _, line in group)]
    return "\n".join(text)


def _justified(cells: Sequence[str], widths: Sequence[int]) -> tuple[str, ...]:
    numbers = (
        cell.rjust(width) for cell, width in zip(cells[NUMBERS], widths[NUMBERS], strict=True)
    )
    return (*cells[: NUMBERS.start], *numbers)


def _cells(row: Row) -> tuple[str, ...]:
    bound = "<= " if row.relation == "<=" else ""
    return (
        row.case,
        row.quantity,
        f"{bound}{row.expected:.9g}",
        f"{row.measured:.9g}",
        f"{row.error:.2g}",
        _percent_text(row.relative_error),
        "-" if row.tolerance is None else f"{row.tolerance:.2g}",
    )


def _percent_text(ratio: float | None) -> str:
    if ratio is None:
        return "-"
    return "<0.01%" if 0.0 < ratio < LEAST_PERCENT_SHOWN else f"{ratio:.2%}"
