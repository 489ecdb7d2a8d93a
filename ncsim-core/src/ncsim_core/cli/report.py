"""``ncsim report``: tables of a study."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ncsim_core.cli.tables import aligned
from ncsim_core.errors import ScenarioError

if TYPE_CHECKING:
    from ncsim_core.sweep.table import Table


class ReportTable(StrEnum):
    """Which table."""

    SUMMARY = "summary"
    RUNS = "runs"
    POLICIES = "policies"
    PAIRED = "paired"


class ReportFormat(StrEnum):
    """How it is written."""

    TERMINAL = "terminal"
    MARKDOWN = "markdown"
    LATEX = "latex"
    CSV = "csv"
    PARQUET = "parquet"


def report(  # noqa: PLR0913 - one parameter per option
    study: Annotated[Path, typer.Argument(metavar="STUDY", help="Folder of a sweep.")],
    *,
    show: Annotated[
        ReportTable,
        typer.Option(
            "--table",
            help="summary: means with intervals over seeds; runs: every run; policies: winners, "
            "inversions and regret; paired: differences along one column.",
        ),
    ] = ReportTable.SUMMARY,
    measure: Annotated[str, typer.Option(help="What is averaged.")] = "makespan_s",
    policy: Annotated[str, typer.Option(help="Column of the policies.")] = "scheduler",
    mode: Annotated[str, typer.Option(help="Column that tells Solo from Full.")] = "interference",
    along: Annotated[str | None, typer.Option(help="Column of --table paired.")] = None,
    form: Annotated[ReportFormat, typer.Option("--format", "-f")] = ReportFormat.TERMINAL,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="File to write.")] = None,
) -> None:
    """Print a table of a study.

    Example: ncsim report study/ --table policies --format latex
    """
    from ncsim_core.sweep.report import paired, policies, policy_totals, summary
    from ncsim_core.sweep.store import Store
    from ncsim_core.sweep.table import table_of

    with Store(study, must_exist=True) as store:
        runs = table_of(store)
    match show:
        case ReportTable.RUNS:
            tables = [runs]
        case ReportTable.SUMMARY:
            tables = [summary(runs, measure)]
        case ReportTable.PAIRED:
            tables = [paired(runs, along or policy, measure)]
        case ReportTable.POLICIES:
            matrix = policies(runs, policy, mode)
            tables = [matrix, policy_totals(matrix)]
    _put(tables, form, output)


def _put(tables: "list[Table]", form: ReportFormat, output: Path | None) -> None:
    if form is ReportFormat.PARQUET:
        if output is None:
            raise ScenarioError("Parquet is no text; give --output FILE")
        tables[0].write_parquet(output)
        return
    text = "\n\n".join(_text(each, form) for each in tables).rstrip("\n") + "\n"
    if output is None:
        typer.echo(text, nl=False)
    else:
        output.write_text(text, encoding="utf-8")


def _text(table: "Table", form: ReportFormat) -> str:
    if form is ReportFormat.MARKDOWN:
        return table.to_markdown()
    if form is ReportFormat.LATEX:
        return table.to_latex()
    if form is ReportFormat.CSV:
        return table.to_csv()
    from ncsim_core.sweep.table import shown_value

    kept = (int, float)
    rows = [
        [v if isinstance(v, kept) or v is None else shown_value(v) for v in r] for r in table.rows
    ]
    return f"{table.title}\n{aligned(rows, table.columns)}"
