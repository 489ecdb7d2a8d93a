"""``ncsim view``: a run as a page."""

import tempfile
import webbrowser
from pathlib import Path
from typing import Annotated

import typer
from ncsim_core.errors import ScenarioError
from ncsim_core.trace.files import write_atomically

app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command()
def view(
    run: Annotated[Path, typer.Argument(metavar="RUN", help="Output folder of a run, or a trace.")],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="Write the report here; open nothing."),
    ] = None,
    compare: Annotated[
        Path | None, typer.Option(metavar="RUN", help="A second run to compare with.")
    ] = None,
    *,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing report.")] = False,
) -> None:
    """Show a run in the browser, or write it as one HTML file that needs no network.

    Example: ncsim view out/ -o report.html
    """
    from ncsim_viz.document import LARGE_BYTES, report_html

    if output is not None and output.exists() and not force:
        raise ScenarioError(f"{output}: exists already; choose another name or give --force")
    text = report_html(run, compare)
    path = output or Path(tempfile.mkdtemp(prefix="ncsim-view-")) / "report.html"
    write_atomically(path, text)
    typer.echo(f"wrote {path} ({len(text) / 1e6:.2f} MB)", err=True)
    if len(text) > LARGE_BYTES:
        typer.echo("this report is large; a coarse trace makes a small one", err=True)
    if output is None:
        typer.echo(path.resolve().as_uri())
        webbrowser.open(path.resolve().as_uri())
