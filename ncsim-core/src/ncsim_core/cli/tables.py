"""Rows as aligned text."""

from collections.abc import Sequence


def aligned(
    rows: Sequence[Sequence[object]], header: Sequence[str], is_number: Sequence[bool] | None = None
) -> str:
    """Return rows as aligned columns; numbers to the right.

    Args:
        rows: Values.
        header: Names of the columns.
        is_number: Which columns stand to the right; by default those that hold numbers alone.
    """
    texts = [[_cell(value) for value in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(header, *texts, strict=True)]
    is_number = is_number or [
        bool(rows) and all(isinstance(row[i], int | float) or row[i] is None for row in rows)
        for i in range(len(header))
    ]
    lines = [_line(header, widths, is_number), *(_line(t, widths, is_number) for t in texts)]
    return "\n".join(line.rstrip() for line in lines)


def _line(cells: Sequence[str], widths: Sequence[int], is_number: Sequence[bool]) -> str:
    return "  ".join(
        cell.rjust(width) if right else cell.ljust(width)
        for cell, width, right in zip(cells, widths, is_number, strict=True)
    )


def _cell(value: object) -> str:
    if value is None:
        return "-"
    return f"{value:.6f}" if isinstance(value, float) else str(value)
