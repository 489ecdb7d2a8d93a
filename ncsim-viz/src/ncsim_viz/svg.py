"""A Gantt chart as SVG text, for notebooks that run no script; needs no drawing package."""

from html import escape
from typing import Final

from ncsim_core.sweep.drawing import COLOURS

from ncsim_viz.gantt import Chart, Row, rows_of

WIDTH: Final = 900
LANE: Final = 22
TOP: Final = 28
AXIS: Final = 34
CHARACTER: Final = 6.2
"""About the width of one at 11 px."""
MAX_MARGIN: Final = 220
MAX_BARS: Final = 5000
"""More would make a notebook heavy; the title says so then."""
TICKS: Final = 5


def svg_gantt(chart: Chart) -> str:
    """Return a chart as one SVG element; transfers are hatched, DAGs have colours."""
    longest = max((len(name) for name in chart.lanes), default=0)
    margin = min(MAX_MARGIN, 16 + CHARACTER * longest)
    height = TOP + LANE * len(chart.lanes) + AXIS
    rows = rows_of(chart)
    some = f" (the first {MAX_BARS} of {len(rows)} bars)" if len(rows) > MAX_BARS else ""
    scale = (WIDTH - margin - 40) / (chart.end_s or 1)
    title = escape(chart.title + some)
    size = f'viewBox="0 0 {WIDTH} {height}" width="{WIDTH}"'
    look = f'role="img" aria-label="{title}" font-family="sans-serif" font-size="11"'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} {look}>',
        f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
        f'<text x="{margin}" y="16" font-size="13">{title}</text>',
        _hatches(),
        *_lanes(chart, margin),
        *(_bar(row, margin, scale) for row in rows[:MAX_BARS]),
        *_axis(chart, margin, scale),
        "</svg>",
    ]
    return "\n".join(parts)


def _hatches() -> str:
    lines = "".join(
        f'<pattern id="ncsim-hatch-{at}" width="6" height="6" patternUnits="userSpaceOnUse" '
        f'patternTransform="rotate(45)"><rect width="6" height="6" fill="white"/>'
        f'<rect width="2" height="6" fill="{colour}"/></pattern>'
        for at, colour in enumerate(COLOURS)
    )
    return f"<defs>{lines}</defs>"


def _lanes(chart: Chart, margin: float) -> list[str]:
    lines = []
    room = int((margin - 10) / CHARACTER)
    for number, name in enumerate(chart.lanes):
        y = TOP + LANE * number
        shown = name if len(name) <= room else f"{name[: room - 1]}\u2026"
        lines.append(f'<line x1="{margin}" x2="{WIDTH - 20}" y1="{y}" y2="{y}" stroke="#ddd"/>')
        place = f'x="{margin - 6}" y="{y + LANE * 0.7:g}"'
        lines.append(f'<text {place} text-anchor="end">{escape(shown)}</text>')
    return lines


def _bar(row: Row, margin: float, scale: float) -> str:
    bar = row.bar
    x, width = margin + bar.start_s * scale, max(0.5, (bar.end_s - bar.start_s) * scale)
    y, height = TOP + LANE * (bar.lane + 0.06 + 0.88 * row.bottom), LANE * 0.88 * row.height
    at = bar.dag % len(COLOURS)
    fill = COLOURS[at] if bar.kind == "task" else f"url(#ncsim-hatch-{at})"
    tip = f"{bar.label}: {bar.start_s:g} s to {bar.end_s:g} s"
    shape = (
        f'<rect x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}" fill="{fill}" '
        f'stroke="{COLOURS[at]}" stroke-width="0.5"><title>{escape(tip)}</title></rect>'
    )
    if bar.kind != "task" or len(bar.label) * CHARACTER + 4 > width:
        return shape
    middle = f'x="{x + width / 2:.2f}" y="{y + height * 0.7:.2f}"'
    return f'{shape}<text {middle} text-anchor="middle" fill="white">{escape(bar.label)}</text>'


def _axis(chart: Chart, margin: float, scale: float) -> list[str]:
    y = TOP + LANE * len(chart.lanes)
    lines = [f'<line x1="{margin}" x2="{WIDTH - 20}" y1="{y}" y2="{y}" stroke="#555"/>']
    for tick in range(TICKS + 1):
        at_s = chart.end_s * tick / TICKS
        x = margin + at_s * scale
        lines.append(f'<line x1="{x:.2f}" x2="{x:.2f}" y1="{y}" y2="{y + 4}" stroke="#555"/>')
        lines.append(f'<text x="{x:.2f}" y="{y + 18}" text-anchor="middle">{at_s:.4g} s</text>')
    return lines
