"""A Gantt chart in characters: how busy each node is, column by column, and what it sends."""

import os
import shutil
from typing import Final, NamedTuple, TextIO

from ncsim_core.trace.run_trace import RunTrace

from ncsim_viz.gantt import Chart, chart_of_run

BLOCKS: Final = " ▁▂▃▄▅▆▇█"
PLAIN: Final = " .:-=+*#@"
"""The same eight steps for terminals without block characters."""
MIN_COLUMNS: Final = 20
MAX_NAME: Final = 24


class TerminalSize(NamedTuple):
    """What a terminal can show.

    Args:
        columns: Characters per line.
        has_blocks: Whether it has block characters.
    """

    columns: int
    has_blocks: bool


def terminal_size(stream: TextIO) -> TerminalSize:
    """Return what a stream can show; 80 columns if it is no terminal."""
    columns = shutil.get_terminal_size((80, 24)).columns
    encoding = (getattr(stream, "encoding", None) or "ascii").lower().replace("-", "")
    has_blocks = encoding.startswith("utf") and os.environ.get("TERM") != "dumb"
    return TerminalSize(columns, has_blocks)


def terminal_gantt(run: RunTrace, size: TerminalSize) -> str:
    """Return a run's Gantt chart as text, lines no longer than the terminal."""
    return drawn(chart_of_run(run), size)


def drawn(chart: Chart, size: TerminalSize) -> str:
    """Return a chart as text: for each lane and column the share of time something is on it.

    Heights tell it; there is no colour.
    """
    longest = max(map(len, chart.lanes), default=0)
    margin = min(longest, MAX_NAME, max(4, size.columns // 3))
    columns = max(MIN_COLUMNS, size.columns - margin - 3)
    glyphs = BLOCKS if size.has_blocks else PLAIN
    rule, corner = ("│", "└") if size.has_blocks else ("|", "+")
    shares = _shares(chart, columns)
    lines = [_printable(chart.title, size)]
    for name, row in zip(chart.lanes, shares, strict=True):
        text = "".join(_glyph(share, glyphs) for share in row)
        lines.append(f"{_fitted(_printable(name, size), margin)} {rule}{text}{rule}")
    dash = "─" if size.has_blocks else "-"
    lines.append(f"{' ' * margin} {corner}{_axis(chart.end_s, columns, dash)}")
    legend = f"{glyphs[1]} little to {glyphs[-1]} all of a column's {chart.end_s / columns:.3g} s"
    lines.append(f"{' ' * margin}  {legend}")
    return "\n".join(line[: size.columns].rstrip() for line in lines)


def _shares(chart: Chart, columns: int) -> list[list[float]]:
    """Return for each lane and column the share of time that is covered, overlaps once."""
    width_s = chart.end_s / columns if chart.end_s > 0 else 1.0
    rows = [[0.0] * columns for _ in chart.lanes]
    reached_s = [0.0] * len(chart.lanes)
    for bar in sorted(chart.bars, key=lambda each: each.start_s):
        start_s = max(bar.start_s, reached_s[bar.lane])
        reached_s[bar.lane] = max(reached_s[bar.lane], bar.end_s)
        first = min(columns - 1, int(start_s / width_s))
        last = min(columns - 1, int(bar.end_s / width_s))
        for column in range(first, last + 1):
            left_s, right_s = column * width_s, (column + 1) * width_s
            covered_s = min(bar.end_s, right_s) - max(start_s, left_s)
            rows[bar.lane][column] += max(0.0, covered_s) / width_s
    return rows


def _glyph(share: float, glyphs: str) -> str:
    """Return the character for a share; anything at all is visible, only everything is full."""
    steps = len(glyphs) - 1
    if share <= 0:
        return glyphs[0]
    if share >= 1 - 1e-9:
        return glyphs[-1]
    return glyphs[max(1, min(steps - 1, round(share * steps)))]


def _axis(end_s: float, columns: int, dash: str) -> str:
    first, last = "0", f"{end_s:.6g} s"
    return first + dash * max(1, columns - len(first) - len(last)) + last


def _fitted(name: str, width: int) -> str:
    return name.ljust(width) if len(name) <= width else f"{name[: width - 1]}~"


def _printable(text: str, size: TerminalSize) -> str:
    """Return text that does nothing to a terminal and that it can show."""
    shown = "".join(each if each.isprintable() else "?" for each in text)
    return shown if size.has_blocks else shown.encode("ascii", "replace").decode()
