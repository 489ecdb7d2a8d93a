"""The ``ncsim`` command: verbs, verbs of plug-ins, exit codes."""

import os
import sys
import traceback
from collections.abc import Callable, Sequence
from importlib.metadata import EntryPoint, entry_points
from typing import Annotated

import typer
from typer.exceptions import TyperException

from ncsim_core import __version__
from ncsim_core.cli import (
    compare,
    explain,
    export,
    new,
    plot,
    plugins,
    report,
    run,
    schema,
    sweep,
    trace,
    validate,
)
from ncsim_core.cli.exit_codes import ExitCode
from ncsim_core.errors import EngineError, NcsimError
from ncsim_core.plugins import COMMAND_GROUP

app = typer.Typer(
    name="ncsim",
    no_args_is_help=True,
    rich_markup_mode=None,
    add_completion=False,
    pretty_exceptions_enable=False,
    help=(
        "Simulate DAG workflows on networked compute nodes whose wireless links slow each "
        "other down.\n\nExample: ncsim run scenario.yaml -o out/"
    ),
    epilog="Exit codes: 0 ok, 1 invalid input, 2 a run did not complete, 3 internal error.",
)


@app.callback()
def _options(
    version: Annotated[bool, typer.Option("--version", help="Print the version and exit.")] = False,
) -> None:
    if version:
        typer.echo(f"ncsim-core {__version__}")
        raise typer.Exit


app.command("run")(run.run)
app.command("validate")(validate.validate)
app.command("new")(new.new)
app.command("explain")(explain.explain)
app.command("compare")(compare.compare)
app.command("sweep")(sweep.sweep)
app.command("report")(report.report)
app.command("plot")(plot.plot)
app.add_typer(trace.app, name="trace")
app.command("export")(export.export)
app.add_typer(plugins.app, name="plugins")
app.command("schema")(schema.schema)


def main(args: Sequence[str] | None = None) -> None:
    """Run the command line and leave with its exit code."""
    _mount_plugin_commands()
    sys.exit(exit_code_of(lambda: app(args=args, prog_name="ncsim", standalone_mode=False)))


def exit_code_of(command: Callable[[], object]) -> int:  # noqa: C901, PLR0911 - flat
    """Return the exit code of a command, after printing what went wrong to stderr."""
    try:
        code = command()
    except typer.Exit as stop:
        return stop.exit_code
    except TyperException as error:
        error.show() if hasattr(error, "show") else _complain(str(error))
        return ExitCode.INVALID_INPUT
    except EngineError as error:
        return _internal_error(error)
    except NcsimError as error:
        _complain(str(error))
        return ExitCode.INVALID_INPUT
    except (KeyboardInterrupt, typer.Abort):
        _complain("interrupted; nothing was written under a final name")
        return ExitCode.INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return ExitCode.OK
    except OSError as error:
        _complain(f"{error.filename or 'input/output'}: {error.strerror or error}")
        return ExitCode.INVALID_INPUT
    except Exception as error:
        return _internal_error(error)
    return code if isinstance(code, int) else ExitCode.OK


def _complain(message: str) -> None:
    print(message, file=sys.stderr)  # noqa: T201 - the command line speaks through stderr


def _internal_error(error: Exception) -> ExitCode:
    _complain(
        f"internal error: {type(error).__name__}: {error}\n"
        "This is a bug in ncsim or in a plug-in. Please report it with the scenario; "
        "NCSIM_DEBUG=1 prints the traceback."
    )
    if os.environ.get("NCSIM_DEBUG"):
        traceback.print_exception(error)
    return ExitCode.INTERNAL_ERROR


def _mount_plugin_commands() -> None:
    """Offer the verbs of plug-ins; each is imported only when it is used."""
    for entry_point in sorted(entry_points(group=COMMAND_GROUP), key=lambda each: each.name):
        package = entry_point.dist.name if entry_point.dist else "a plug-in"
        app.command(
            entry_point.name,
            help=f"Given by {package}; see ncsim {entry_point.name} --help.",
            add_help_option=False,
            context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
        )(_forwarder(entry_point))


def _forwarder(entry_point: EntryPoint) -> Callable[[typer.Context], object]:
    def forward(context: typer.Context) -> object:
        command = entry_point.load()
        prog_name = f"ncsim {entry_point.name}"
        return command(args=context.args, prog_name=prog_name, standalone_mode=False)

    return forward
