"""``ncsim compare``: what changed between two runs, and why?"""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ncsim_core.metrics.comparison import Comparison


def compare(
    first: Annotated[
        Path, typer.Argument(metavar="FIRST", help="Trace or output folder of the first run.")
    ],
    second: Annotated[
        Path, typer.Argument(metavar="SECOND", help="Trace or output folder of the second run.")
    ],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Compare two runs: configuration, makespan, every task and transfer that changed, and why.

    Changes are second minus first; a positive time is later or longer in the second run.

    Example: ncsim compare solo/ full/
    """
    from ncsim_core.metrics.comparison import compare_runs
    from ncsim_core.metrics.documents import comparison_document
    from ncsim_core.trace.files import json_text
    from ncsim_core.trace.loading import load_run

    comparison = compare_runs(load_run(first), load_run(second))
    if as_json:
        typer.echo(json_text(comparison_document(comparison)), nl=False)
        return
    for line in comparison_lines(comparison):
        typer.echo(line)


def comparison_lines(comparison: "Comparison") -> "Iterator[str]":
    """Yield a comparison as tables."""
    yield "configuration" if comparison.differences else "configuration: no difference"
    for setting, before, after in comparison.differences:
        yield f"  {setting}: {before} | {after}"
    first, second = comparison.first_makespan_s, comparison.second_makespan_s
    ratio = comparison.makespan_ratio
    yield (
        f"makespan: {_makespan(first, comparison.first_status)} | "
        f"{_makespan(second, comparison.second_status)}"
        f"{'' if ratio is None else f', ratio {ratio:.6f}'}"
    )
    yield f"tasks that changed: {len(comparison.tasks)}"
    for task in comparison.tasks:
        nodes = _either(task.first_node or "-", task.second_node or "-")
        yield f"  {task.ended_us / 1e6:+14.6f} s  {task.label} on {nodes}: {task.why}"
    yield f"transfers that changed: {len(comparison.transfers)}"
    for transfer in comparison.transfers:
        routes = _either(_route(transfer.first_route), _route(transfer.second_route))
        yield f"  {transfer.took_us / 1e6:+14.6f} s  {transfer.label} over {routes}: {transfer.why}"
    for line in comparison.unmatched:
        yield f"  {line}"


def _makespan(makespan_s: float | None, status: str) -> str:
    return status if makespan_s is None else f"{makespan_s:.6f} s"


def _route(links: tuple[str, ...]) -> str:
    return ", ".join(links) or "one node"


def _either(first: str, second: str) -> str:
    return first if first == second else f"{first} | {second}"
