"""``ncsim report``: tables of a study."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ncsim_core.cli.studies import (
    Digits,
    FullMode,
    Measure,
    ModeColumn,
    PolicyColumn,
    StudyFolder,
    runs_of,
)
from ncsim_core.cli.tables import aligned
from ncsim_core.errors import ScenarioError

if TYPE_CHECKING:
    from ncsim_core.sweep.table import Table


class ReportTable(StrEnum):
    """Which table."""

    SUMMARY = "summary"
    RUNS = "runs"
    POLICIES = "policies"
    CASES = "cases"
    TOTALS = "totals"
    PAIRED = "paired"


class ReportFormat(StrEnum):
    """How it is written."""

    TERMINAL = "terminal"
    MARKDOWN = "markdown"
    LATEX = "latex"
    CSV = "csv"
    PARQUET = "parquet"


def report(  # noqa: PLR0913 - one parameter per option
    study: StudyFolder,
    *,
    show: Annotated[
        ReportTable,
        typer.Option(
            "--table",
            help="summary: means with intervals over seeds; runs: every run; policies: ratios, "
            "winners, inversion and regret of every case; cases: the same over seeds; totals: "
            "over everything; paired: differences along one column.",
        ),
    ] = ReportTable.SUMMARY,
    measure: Measure = "makespan_s",
    policy: PolicyColumn = "scheduler",
    mode: ModeColumn = "interference",
    full: FullMode = None,
    along: Annotated[str | None, typer.Option(help="Column of --table paired.")] = None,
    confidence: Annotated[
        float, typer.Option(min=0.5, max=0.9999, help="Of the intervals.")
    ] = 0.95,
    digits: Digits = 3,
    form: Annotated[
        ReportFormat, typer.Option("--format", "-f", help="How it is written.")
    ] = ReportFormat.TERMINAL,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="File to write.")] = None,
) -> None:
    """Print a table of a study.

    Example: ncsim report study/ --table cases --format latex
    """
    from ncsim_core.sweep.report import paired, policies, policy_cases, policy_totals, summary

    runs = runs_of(study)
    match show:
        case ReportTable.RUNS:
            table = runs
        case ReportTable.SUMMARY:
            table = summary(runs, measure, confidence)
        case ReportTable.PAIRED:
            table = paired(runs, along or policy, measure, confidence)
        case ReportTable.POLICIES:
            table = policies(runs, policy, mode, full=full)
        case ReportTable.CASES:
            table = policy_cases(policies(runs, policy, mode, full=full), confidence)
        case ReportTable.TOTALS:
            table = policy_totals(policies(runs, policy, mode, full=full))
    _put(table, form, digits, output)


def _put(table: "Table", form: ReportFormat, digits: int, output: Path | None) -> None:
    from ncsim_core.trace.files import write_atomically

    if form is ReportFormat.PARQUET:
        if output is None:
            raise ScenarioError("Parquet is no text; give --output FILE")
        table.write_parquet(output)
        return
    text = _text(table, form, digits).rstrip("\n") + "\n"
    if output is None:
        typer.echo(text, nl=False)
    else:
        output.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(output, text)


def _text(table: "Table", form: ReportFormat, digits: int) -> str:
    if form is ReportFormat.MARKDOWN:
        return table.to_markdown(digits)
    if form is ReportFormat.LATEX:
        return table.to_latex(digits)
    if form is ReportFormat.CSV:
        return table.to_csv()
    return terminal_text(table, digits)


def terminal_text(table: "Table", digits: int = 3) -> str:
    """Return a table as people read it in a terminal, its title above it."""
    from ncsim_core.sweep.formatting import cells

    return (
        f"{table.title}\n"
        f"{aligned(cells(table.rows, table.heads, digits), table.columns, table.numeric)}"
    )
