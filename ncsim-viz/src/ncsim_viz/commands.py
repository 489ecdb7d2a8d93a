"""``ncsim view``: runs and studies as a page."""

import sys
import tempfile
import webbrowser
from pathlib import Path
from typing import Annotated

import typer
from ncsim_core.cli.choices import refuse_endless
from ncsim_core.errors import ScenarioError

app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command()
def view(  # noqa: PLR0913 - one parameter per option
    run: Annotated[
        Path | None,
        typer.Argument(metavar="[RUN]", help="Folder of a run or a study, or a trace file."),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="Write the report here; open nothing."),
    ] = None,
    compare: Annotated[
        Path | None, typer.Option(metavar="RUN", help="A second run to compare with.")
    ] = None,
    serve: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Serve all runs and studies below DIR, live ones too."),
    ] = None,
    *,
    port: Annotated[
        int, typer.Option(help="Of --serve; 0 takes a free one.", min=0, max=65535)
    ] = 0,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open a browser.")] = True,
    max_wall: Annotated[
        float, typer.Option(help="Seconds that a run from the page may take.", min=1)
    ] = 3600.0,
    max_memory: Annotated[
        int, typer.Option(help="MB that a run from the page may take.", min=200)
    ] = 4000,
    terminal: Annotated[
        bool, typer.Option("--terminal", help="Draw the Gantt chart in the terminal instead.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing report.")] = False,
) -> None:
    """Show a run or a study in the browser, or write it as one HTML file that needs no network.

    With --serve, show a whole folder, follow runs while they go on, and start new ones.

    Example: ncsim view out/ -o report.html
    """
    if (run is None) == (serve is None):
        raise ScenarioError("give a run or a study, or --serve DIR for all in a folder")
    refuse_endless(max_wall=max_wall)
    if serve is not None:
        _serve(serve, port, (max_wall, max_memory), opens_browser=browser)
    elif run is not None and terminal:
        _draw(run)
    elif run is not None:
        _report(run, compare, output, force=force, opens_browser=browser)


def _serve(folder: Path, port: int, limits: tuple[float, int], *, opens_browser: bool) -> None:
    from ncsim_viz.server.child import Limits
    from ncsim_viz.server.serving import ViewerServer, instructions, serve

    if not folder.is_dir():
        raise ScenarioError(f"{folder}: is no folder; --serve takes one with runs or studies in it")
    try:
        server = ViewerServer(folder, port, Limits(wall_s=limits[0], memory_MB=limits[1]))
    except OSError as error:
        raise ScenarioError(f"port {port}: {error.strerror}; --port 0 takes a free one") from error
    typer.echo(instructions(server))
    sys.stdout.flush()
    if opens_browser:
        webbrowser.open(server.url)
    serve(server)


def _draw(run: Path) -> None:
    from ncsim_core.trace.loading import load_run

    from ncsim_viz.terminal import terminal_gantt, terminal_size

    typer.echo(terminal_gantt(load_run(run), terminal_size(sys.stdout)))


def _report(
    run: Path, compare: Path | None, output: Path | None, *, force: bool, opens_browser: bool
) -> None:
    from ncsim_core.trace.files import write_atomically

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
        if opens_browser:
            webbrowser.open(path.resolve().as_uri())
