"""``ncsim export``: a run in the forms that other tools read."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from ncsim_core.errors import ScenarioError


class Form(StrEnum):
    """What a run can be exported to."""

    PUBLISHED = "published"
    CSV = "csv"
    PERFETTO = "perfetto"
    PARQUET = "parquet"


DEFAULT_OUTPUTS = {
    Form.PUBLISHED: Path("published.jsonl"),
    Form.CSV: Path("csv"),
    Form.PERFETTO: Path("perfetto.json"),
    Form.PARQUET: Path("parquet"),
}


def export(
    run: Annotated[
        Path, typer.Argument(metavar="RUN", help="Trace file, or the output folder of a run.")
    ],
    form: Annotated[Form, typer.Option("--to", help="Form to write.")],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="File (published, perfetto) or folder (csv, parquet); - is standard output. "
            "By default the form's own name in the current folder.",
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite files.")] = False,
) -> None:
    """Write a run in another form.

    published: events of the published ncsim. csv, parquet: tables of tasks, transfers and rates.
    perfetto: Chrome JSON for ui.perfetto.dev.

    Example: ncsim export out/ --to csv -o out-csv/
    """
    target = output or DEFAULT_OUTPUTS[form]
    if form in (Form.CSV, Form.PARQUET):
        _export_tables(run, form, target, force=force)
    else:
        _export_text(run, form, target, force=force)


def _export_text(run: Path, form: Form, target: Path, *, force: bool) -> None:
    from ncsim_core.trace.export.perfetto import perfetto_text
    from ncsim_core.trace.export.published import published_text
    from ncsim_core.trace.files import write_atomically
    from ncsim_core.trace.loading import load_run

    text = published_text(run) if form is Form.PUBLISHED else perfetto_text(load_run(run))
    if str(target) == "-":
        typer.echo(text, nl=False)
        return
    _refuse_taken(target, force=force)
    write_atomically(target, text)
    typer.echo(f"written: {target}")


def _export_tables(run: Path, form: Form, folder: Path, *, force: bool) -> None:
    from ncsim_core.trace.export.tables import TABLES, write_csv, write_parquet
    from ncsim_core.trace.loading import load_run

    if str(folder) == "-":
        raise ScenarioError(f"--to {form} writes several files; give a folder with -o")
    for name in TABLES:
        _refuse_taken(folder / f"{name}.{form}", force=force)
    tables = load_run(run)
    folder.mkdir(parents=True, exist_ok=True)
    write = write_csv if form is Form.CSV else write_parquet
    write(tables, folder)
    typer.echo(f"written: {folder}/ ({', '.join(f'{name}.{form}' for name in TABLES)})")


def _refuse_taken(path: Path, *, force: bool) -> None:
    if path.exists() and not force:
        raise ScenarioError(f"{path}: exists already; choose another name or give --force")
