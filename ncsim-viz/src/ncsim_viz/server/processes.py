"""Starts processes with limits, and ends them with all that they started."""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Final, Literal, TypeAlias

from ncsim_viz.server.child import Limits, command

GRACE_s: Final = 3.0
"""What an interrupted process gets to tidy up."""
SAID_BYTES: Final = 16_000
KILL: Final = signal.SIGTERM if sys.platform == "win32" else signal.SIGKILL

Ending: TypeAlias = Literal["cancelled", "out of time"]


class LimitedProcess:
    """A process with limits and what it says on stderr.

    Args:
        limits: What it may take.
        entry: ``package.module:function`` to call.
        arguments: Its ``sys.argv``.
    """

    def __init__(self, limits: Limits, entry: str, *arguments: str) -> None:
        self._folder = Path(tempfile.mkdtemp(prefix="ncsim-view-"))
        self._limits = limits
        self._started_s = time.monotonic()
        self.interrupted: Ending | None = None
        self._kill_at_s: float | None = None
        with (
            (self._folder / "stdout").open("wb") as stdout,
            (self._folder / "stderr").open("wb") as stderr,
        ):
            self._process = subprocess.Popen(
                command(limits, entry, *arguments),
                stdin=subprocess.DEVNULL,
                stdout=stdout,
                stderr=stderr,
                start_new_session=True,
            )

    @property
    def id(self) -> int:
        """Return its process id."""
        return self._process.pid

    @property
    def ran_s(self) -> float:
        """Return for how long it has been running."""
        return time.monotonic() - self._started_s

    def poll(self) -> int | None:
        """Return the exit code, ``None`` while it runs; ends what is out of time."""
        code = self._process.poll()
        if code is None and self.interrupted is None and self.ran_s > self._limits.wall_s:
            self.interrupt("out of time")
        if code is None and self._kill_at_s is not None and time.monotonic() > self._kill_at_s:
            self._signal(KILL)
        return code

    def interrupt(self, why: Ending) -> None:
        """Ask it to stop, as Ctrl-C does; ``poll`` kills it if it takes too long."""
        if self.interrupted is None:
            self.interrupted = why
            self._kill_at_s = time.monotonic() + GRACE_s
            self._signal(signal.SIGINT)

    def close(self) -> None:
        """Kill it if it still runs, and remove its files."""
        if self._process.poll() is None:
            self._signal(KILL)
            self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)

    def wait(self) -> int:
        """Return its exit code when it has ended, or has been ended."""
        while (code := self.poll()) is None:
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(0.1)
        return code

    def answer(self) -> bytes:
        """Return what it wrote to stdout."""
        return (self._folder / "stdout").read_bytes()

    def complaint(self) -> str:
        """Return the last of what it wrote to stderr."""
        said = (self._folder / "stderr").read_bytes()[-SAID_BYTES:]
        return said.decode("utf-8", "replace").strip()

    def _signal(self, number: int) -> None:
        """Send a signal to the process and all that it started, in so far as they live."""
        with contextlib.suppress(ProcessLookupError, PermissionError):
            if sys.platform == "win32":
                self._process.send_signal(number)
            else:
                os.killpg(self._process.pid, number)
