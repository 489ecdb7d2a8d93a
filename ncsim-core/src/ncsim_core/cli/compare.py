"""``ncsim compare``: what changed between two runs, and why?"""

from typing import TYPE_CHECKING, Annotated

import typer

from ncsim_core.cli.studies import Digits

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ncsim_core.metrics.comparison import Comparison
    from ncsim_core.sweep.selecting import Selection
    from ncsim_core.sweep.table import Table


def compare(
    first: Annotated[str, typer.Argument(metavar="FIRST", help="A run, or a column of a study.")],
    second: Annotated[str, typer.Argument(metavar="SECOND", help="What to compare it with.")],
    *,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    every: Annotated[
        bool, typer.Option("--all", help="Every pair of runs, not only means over seeds.")
    ] = False,
    digits: Digits = 3,
) -> None:
    """Compare two runs, or two columns of a study: what changed, and why?

    A run is a trace, the output folder of a run, or STUDY@COLUMN=VALUE,... that names one run of
    a study; two runs are compared by configuration, makespan, and every task and transfer that
    changed. STUDY@COLUMN=VALUE that names many is compared pair by pair, and over seeds:
    makespans, difference, ratio, and the regret of taking either one.
    Changes are second minus first; a positive time is later or longer in the second run.

    Example: ncsim compare study@interference=none study@interference=csma_bianchi
    """
    from ncsim_core.sweep.selecting import selection_of

    columns = selection_of(first), selection_of(second)
    if columns[0] is not None and columns[1] is not None:
        tables = _tables_of(columns[0], columns[1])
        if tables is not None:
            _print_tables(tables, digits, every=every, as_json=as_json)
            return
    _compare_runs(first, second, as_json=as_json)


def _compare_runs(first: str, second: str, *, as_json: bool) -> None:
    from ncsim_core.cli.runs import run_of
    from ncsim_core.metrics.comparison import compare_runs
    from ncsim_core.metrics.documents import comparison_document
    from ncsim_core.trace.files import json_text

    comparison = compare_runs(run_of(first), run_of(second))
    if as_json:
        typer.echo(json_text(comparison_document(comparison)), nl=False)
        return
    for line in comparison_lines(comparison):
        typer.echo(line)


def _tables_of(first: "Selection", second: "Selection") -> "dict[str, Table] | None":
    """Return the comparison of two columns; ``None`` if each is one run."""
    from ncsim_core.sweep.comparing import pairs_cases, pairs_table, pairs_totals
    from ncsim_core.sweep.selecting import matching, resolved
    from ncsim_core.sweep.store import Store

    with Store(first.study, must_exist=True) as one, Store(second.study, must_exist=True) as other:
        sides = matching(one, first.values), matching(other, second.values)
        compared = {
            **resolved(one.current()[0], first.values),
            **resolved(other.current()[0], second.values),
        }
    if len(sides[0]) == len(sides[1]) == 1:
        return None
    table = pairs_table(*sides, compared)
    return {"pairs": table, "cases": pairs_cases(table), "totals": pairs_totals(table)}


def _print_tables(tables: "dict[str, Table]", digits: int, *, every: bool, as_json: bool) -> None:
    from ncsim_core.cli.report import terminal_text
    from ncsim_core.trace.files import json_text

    if as_json:
        found = {name: table.to_dicts() for name, table in tables.items()}
        typer.echo(json_text(found), nl=False)
        return
    wanted = (tables["pairs" if every else "cases"], tables["totals"])
    typer.echo("\n\n".join(terminal_text(table, digits) for table in wanted))


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
    if ratio is not None:
        yield f"regret: {' | '.join(f'{each or 0.0:.1%}' for each in comparison.regrets)}"
    yield f"tasks that changed: {len(comparison.tasks)}"
    for task in comparison.tasks:
        nodes = _either(task.first_node or "-", task.second_node or "-")
        yield f"  {task.ended_us / 1e6:+14.6f} s  {task.label} on {nodes}: {task.why}"
    yield f"transfers that changed: {len(comparison.transfers)}"
    for transfer in comparison.transfers:
        routes = _either(_route(transfer.first_route), _route(transfer.second_route))
        why = transfer.why.replace("_", " ")
        yield f"  {transfer.took_us / 1e6:+14.6f} s  {transfer.label} over {routes}: {why}"
    for line in comparison.unmatched:
        yield f"  {line}"


def _makespan(makespan_s: float | None, status: str) -> str:
    return status if makespan_s is None else f"{makespan_s:.6f} s"


def _route(links: tuple[str, ...]) -> str:
    return ", ".join(links) or "one node"


def _either(first: str, second: str) -> str:
    return first if first == second else f"{first} | {second}"
