"""``ncsim trace``: print a trace for people, verify it, or take it out of a report."""

from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ncsim_core.cli.exit_codes import ExitCode

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ncsim_core.trace.check import TraceReport

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Look at the trace of a run, verify it, or take it out of a report.",
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

    Leaves with exit code 1 if anything is wrong. It looks at the trace alone: whether the scenario
    beside it gives that trace, ncsim reproduce tells.
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


@app.command("extract", epilog="Example: ncsim trace extract report.html -o trace.jsonl")
def extract(
    report: Annotated[Path, typer.Argument(metavar="REPORT", help="Report of ncsim view.")],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="File to write; compressed if it ends in .gz.")
    ] = Path("trace.jsonl"),
    *,
    number: Annotated[
        int, typer.Option("--number", "-n", min=1, help="Which, if the report compares two runs.")
    ] = 1,
    force: Annotated[bool, typer.Option("--force", help="Overwrite the file.")] = False,
) -> None:
    """Take the trace out of a report, byte for byte as the run wrote it."""
    from ncsim_core.errors import ScenarioError
    from ncsim_core.trace.embedding import embedded_traces, traces_in
    from ncsim_core.trace.files import write_atomically

    if output.exists() and not force:
        raise ScenarioError(f"{output}: exists already; choose another name or give --force")
    page = report.read_text(encoding="utf-8", errors="replace")
    traces = embedded_traces(page) if output.suffix == ".gz" else traces_in(page)
    if not traces:
        raise ScenarioError(f"{report}: holds no trace; is it a report of ncsim view?")
    if number > len(traces):
        raise ScenarioError(f"{report}: holds {len(traces)} trace(s), no number {number}")
    write_atomically(output, traces[number - 1])
    typer.echo(f"written: {output}")


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
