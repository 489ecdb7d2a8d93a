"""One line of the validation: what was expected, what came out, and what that means."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias

from ncsim_core.cli.tables import aligned

Stage: TypeAlias = Literal["internal", "literature", "packet"]
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
        expected: The number it should be.
        source: Where that number is from.
        measured: What came out.
        tolerance: How far the two may be apart. ``None`` marks a comparison with packets in
            which the paper itself states an error: it is shown, not judged.
    """

    stage: Stage
    experiment: str
    case: str
    quantity: str
    expected: float
    source: str
    measured: float
    tolerance: float | None

    @property
    def error(self) -> float:
        """Return by how much measured differs from expected."""
        return abs(self.measured - self.expected)

    @property
    def relative_error(self) -> float | None:
        """Return the error over the expected number, ``None`` if that is 0."""
        return self.error / abs(self.expected) if self.expected else None

    @property
    def verdict(self) -> Verdict:
        """Return what the comparison says; ``differs`` where an error is known and stated."""
        if self.tolerance is None:
            return "differs"
        return "pass" if self.error <= self.tolerance else "FAIL"

    def to_dict(self) -> dict[str, object]:
        """Return the row as plain data."""
        derived = {
            "error": self.error,
            "relative_error": self.relative_error,
            "verdict": self.verdict,
        }
        return asdict(self) | derived


def half_a_digit(decimals: int) -> float:
    """Return how far a number may be from one printed with so many decimals."""
    return 0.5 * 10.0**-decimals * (1.0 + 1e-9)


def read_data(name: str) -> Mapping[str, Any]:
    """Return one of the package's files of published numbers."""
    data: Mapping[str, Any] = json.loads((DATA / f"{name}.json").read_text("utf-8"))
    return data


HEADINGS = ("experiment", "case", "quantity", "expected", "measured", "error", "verdict", "source")


def table_text(rows: Iterable[Row]) -> str:
    """Return rows as an aligned table."""
    return aligned([_cells(row) for row in rows], HEADINGS)


def _cells(row: Row) -> tuple[str, ...]:
    relative = row.relative_error
    error = f"{row.error:.2g}" if relative is None or row.error == 0 else f"{relative:.2%}"
    if relative is not None and 0 < relative < 1e-4:  # noqa: PLR2004 - below a hundredth of a percent
        error = f"{row.error:.2g}"
    numbers = (f"{row.expected:.9g}", f"{row.measured:.9g}", error)
    return (row.experiment, row.case, row.quantity, *numbers, row.verdict, row.source)
