"""Carries out the paper's workflow evaluation and compares it with the printed numbers.

``make paper`` runs it. Every row is told to equal what the paper prints, or not; the exit code is 1
if any does not. Studies, tables and figures are left in ``out/paper``.
"""

import sys
from collections.abc import Iterable
from pathlib import Path

from ncsim_core.sweep.figures import draw_means, draw_regret, draw_slowdown
from ncsim_core.sweep.running import run_sweep
from ncsim_core.sweep.table import Table
from route_load import draw_route_load, route_load
from rows import (
    ROUTINGS,
    Row,
    concurrent_rows,
    factorial_rows,
    interference_rows,
    payload_rows,
    route_load_rows,
    routing_rows,
)

HERE = Path(__file__).parent
TABLES = {  # by name of the printed table, file and columns
    "tab:routing": ("routing", ("network and DAG", "W (s)", "M (s)", "winner")),
    "tab:interference": (
        "interference",
        ("network and DAG", *(f"{s} {w}" for s in ("HEFT", "CPOP") for w in ("Solo", "Full", "%"))),
    ),
    "tab:winner_matrix": (
        "winner_matrix",
        ("network and DAG", *(f"{r} {p}" for r in "WM" for p in ("H", "C", "RR", "Solo"))),
    ),
}
FIGURES = (".pdf", ".png")


def main(output: Path = Path("out/paper")) -> int:
    """Reproduce everything under a folder and return the exit code."""
    names = ("routing", "interference", "factorial", "payload", "concurrent")
    runs = {name: study(name, output) for name in names}
    loads = [route_load(routing) for routing in ROUTINGS]
    rows = [
        *routing_rows(runs["routing"]),
        *interference_rows(runs["interference"]),
        *factorial_rows(runs["factorial"]),
        *payload_rows(runs["payload"]),
        *concurrent_rows(runs["concurrent"]),
        *route_load_rows(loads),
    ]
    write_tables(rows, output / "tables")
    for suffix in FIGURES:
        folder = output / "figures"
        draw_regret(runs["factorial"], "scheduler", "interference", folder / f"regret{suffix}")
        draw_slowdown(runs["payload"], "payload_MB", "interference", folder / f"payload{suffix}")
        draw_means(runs["concurrent"], "count", "makespan_s", folder / f"concurrent{suffix}")
        draw_route_load(loads, folder / f"route_load{suffix}")
    return verdict(rows, output)


def study(name: str, output: Path) -> Table:
    """Return all runs of one of the sweep files beside this one."""
    with run_sweep(HERE / f"{name}.yaml", output / name) as results:
        return results.table()


def write_tables(rows: Iterable[Row], folder: Path) -> None:
    """Write the printed tables as they come out, for Markdown and for LaTeX."""
    folder.mkdir(parents=True, exist_ok=True)
    for printed, (name, columns) in TABLES.items():
        body = tuple((row.case, *row.found) for row in rows if row.table == printed)
        table = Table(columns, body, f"The paper's {printed}, reproduced by make paper", heads=1)
        (folder / f"{name}.md").write_text(table.to_markdown() + "\n", encoding="utf-8")
        (folder / f"{name}.tex").write_text(table.to_latex() + "\n", encoding="utf-8")


def verdict(rows: list[Row], output: Path) -> int:
    """Print every row with its verdict, and return the exit code."""
    for row in rows:
        text = "equal" if row.is_equal else f"DIFFERS, printed: {' '.join(map(str, row.printed))}"
        found = " ".join(map(str, row.found))
        say(f"{row.table:<18} {row.case:<24} {found}  {text}")
    equal = sum(row.is_equal for row in rows)
    say(f"{equal} of {len(rows)} rows equal what the paper prints")
    say(f"studies, tables and figures: {output}/")
    return 0 if equal == len(rows) else 1


def say(text: str) -> None:
    """Print a line."""
    sys.stdout.write(text + "\n")


if __name__ == "__main__":
    sys.exit(main())
