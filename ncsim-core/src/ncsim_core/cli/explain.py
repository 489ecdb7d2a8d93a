"""``ncsim explain``: why is the makespan what it is?"""

from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from ncsim_core.metrics.explanation import ChainItem, Explanation


def explain(
    run: Annotated[
        str,
        typer.Argument(
            metavar="RUN",
            help="Trace, output folder of a run, or STUDY@COLUMN=VALUE,... for one of a study.",
        ),
    ],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Split a run's makespan into compute, waiting, and what slowed its transfers.

    Walks the binding chain: the last task to end, the input it waited for longest, the task
    that produced it, and so on. The parts sum to the makespan to the microsecond.

    transfer alone: with the route to itself. sharing loss: to other transfers on the slowest link
    of the route. contention loss: to links with which that link takes turns on the channel. hidden
    loss: to senders that it does not hear. queue wait: a task was ready, its node busy.

    Example: ncsim explain out/
    """
    from ncsim_core.cli.runs import run_of
    from ncsim_core.metrics.documents import explanation_document
    from ncsim_core.metrics.explanation import explain_run
    from ncsim_core.trace.files import json_text
    from ncsim_core.trace.records import TraceError

    found = run_of(run)
    try:
        explanation = explain_run(found)
    except TraceError as error:
        raise TraceError(f"{run}: {error}") from error
    if as_json:
        typer.echo(json_text(explanation_document(explanation)), nl=False)
        return
    for line in explanation_lines(explanation):
        typer.echo(line)


def explanation_lines(explanation: "Explanation") -> list[str]:
    """Return an explanation as a table of the chain and one of the totals."""
    lines = [f"{'from':>12} {'to':>12}  what", *map(_item_line, explanation.chain), ""]
    whole_us = explanation.makespan_us or 1
    lines += [
        f"{str(part).replace('_', ' '):<18} {spent_us / 1e6:>14.6f} s {spent_us / whole_us:>7.1%}"
        for part, spent_us in explanation.totals.items()
        if spent_us
    ]
    return [*lines, f"{'makespan':<18} {explanation.makespan_us / 1e6:>14.6f} s"]


def _item_line(item: "ChainItem") -> str:
    place = f" {'over' if item.kind == 'transfer' else 'on'} {', '.join(item.place)}"
    parts = ", ".join(
        f"{str(part).replace('_', ' ')} {spent_us / 1e6:.6f}"
        for part, spent_us in item.parts.items()
        if spent_us
    )
    span = f"{item.start_us / 1e6:>12.6f} {item.end_us / 1e6:>12.6f}"
    what = f"{item.kind} {item.label}{place if item.place else ''}"
    return f"{span}  {what}{': ' if parts else ''}{parts}"
