"""The ``ncsim`` command: its front page, its version, and the exit codes of all verbs."""

import os
import sys
from collections.abc import Callable, Sequence

from ncsim_core import __version__
from ncsim_core.cli.exit_codes import ExitCode, Interrupted
from ncsim_core.cli.front_page import front_page
from ncsim_core.errors import EngineError, NcsimError


def main(args: Sequence[str] | None = None) -> None:
    """Run the command line and leave with its exit code."""
    words = sys.argv[1:] if args is None else list(args)
    sys.exit(exit_code_of(lambda: _run(words)))


def _run(words: list[str]) -> object:
    if not words:
        _complain(front_page())
        return ExitCode.INVALID_INPUT
    if words[0] in ("--help", "--version"):
        print(front_page() if words[0] == "--help" else f"ncsim-core {__version__}")  # noqa: T201
        return ExitCode.OK
    from ncsim_core.cli.verbs import app

    return app(args=words, prog_name="ncsim", standalone_mode=False)


def exit_code_of(command: Callable[[], object]) -> int:  # noqa: PLR0911 - one per kind of end
    """Return the exit code of a command, after printing what went wrong to stderr."""
    try:
        code = command()
    except EngineError as error:
        return _internal_error(error)
    except NcsimError as error:
        _complain(str(error))
        return ExitCode.INVALID_INPUT
    except (KeyboardInterrupt, Interrupted):
        return _interrupted()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return ExitCode.OK
    except OSError as error:
        _complain(f"{error.filename or 'input/output'}: {error.strerror or error}")
        return ExitCode.INVALID_INPUT
    except Exception as error:
        return _parsing_stopped(error)
    return code if isinstance(code, int) else ExitCode.OK


def _parsing_stopped(error: Exception) -> int:
    """Return the exit code of what typer raises; anything else is a bug of ours."""
    import typer
    from typer.exceptions import TyperException

    if isinstance(error, typer.Exit):
        return error.exit_code
    if isinstance(error, typer.Abort):
        return _interrupted()
    if isinstance(error, TyperException):
        error.show() if hasattr(error, "show") else _complain(str(error))
        return ExitCode.INVALID_INPUT
    return _internal_error(error)


def _interrupted() -> ExitCode:
    _complain("interrupted; nothing was written")
    return ExitCode.INTERRUPTED


def _complain(message: str) -> None:
    print(message, file=sys.stderr)  # noqa: T201 - the command line speaks through stderr


def _internal_error(error: Exception) -> ExitCode:
    _complain(
        f"internal error: {type(error).__name__}: {error}\n"
        "This is a bug in ncsim or in a plug-in. Please report it with the scenario; "
        "NCSIM_DEBUG=1 prints the traceback."
    )
    if os.environ.get("NCSIM_DEBUG"):
        import traceback

        traceback.print_exception(error)
    return ExitCode.INTERNAL_ERROR
