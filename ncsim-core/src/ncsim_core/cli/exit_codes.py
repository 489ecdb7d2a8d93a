"""What ``ncsim`` tells the shell; every verb, those of plug-ins too, takes it from here."""

from enum import IntEnum


class ExitCode(IntEnum):
    """How a command ended."""

    OK = 0
    INVALID_INPUT = 1
    RUN_DID_NOT_COMPLETE = 2
    INTERNAL_ERROR = 3
    INTERRUPTED = 130


class Interrupted(Exception):  # noqa: N818 - it is no error
    """Ctrl-C, on its way past typer."""
