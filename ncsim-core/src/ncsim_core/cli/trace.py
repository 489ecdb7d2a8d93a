"""``ncsim trace``: print a trace for people, or verify it."""

from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ncsim_core.cli.exit_codes import ExitCode

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ncsim_core.trace.check import TraceReport

app = typer.Typer(
    no_args_is_help=True, rich_markup_mode=None, help="Look at the trace of a run, or verify it."
)

RunPath = Annotated[
    Path, typer.Argument(metavar="RUN", help="Trace file, or the output folder of a run.")
]


@app.command("show", epilog="Example: ncsim trace show out/ --kind recalc --limit 20")
def show(
    run: RunPath,
    kind: Annotated[
        list[str] | None, typer.Option("--kind", "-k", help="Only this kind; may be repeated.")
    ] = None,
    limit: Annotated[
        int | None, typer.Option("--limit", "-n", min=0, help="Stop after that many lines.")
    ] = None,
) -> None:
    """Print a trace with names instead of numbers, one line per record."""
    from ncsim_core.trace.show import readable_lines

    for line in islice(readable_lines(run, kind or ()), limit):
        typer.echo(line)


@app.command("check", epilog="Example: ncsim trace check out/")
def check(
    runs: Annotated[
        list[Path], typer.Argument(metavar="RUN...", help="Trace files or folders of runs.")
    ],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Verify traces: bytes are conserved, nodes do one thing at a time, causes exist, and more.

    Leaves with exit code 1 if anything is wrong.
    """
    from ncsim_core.trace.check import trace_report

    reports = [trace_report(run) for run in runs]
    if as_json:
        typer.echo(_json_text(reports), nl=False)
    else:
        for report in reports:
            _print_report(report)
    if any(report.findings for report in reports):
        raise typer.Exit(ExitCode.INVALID_INPUT)


def _print_report(report: "TraceReport") -> None:
    verdict = f"{len(report.findings)} findings" if report.findings else "nothing wrong"
    typer.echo(f"{report.path}: {report.records} records, {report.status}, {verdict}")
    for finding in report.findings:
        typer.echo(f"{report.path}:{finding.line}: {finding.message}")


def _json_text(reports: "Sequence[TraceReport]") -> str:
    from ncsim_core.trace.files import json_text

    rows = [
        {
            "path": str(report.path),
            "status": report.status,
            "records": report.records,
            "findings": [finding._asdict() for finding in report.findings],
        }
        for report in reports
    ]
    return json_text(rows)
