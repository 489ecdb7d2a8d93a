"""Limits on the clock and on memory, kept even if a plug-in never comes back.

The clock is looked at between two events. A component that does not return from a call is
interrupted a moment later, where the system has alarms, and the run says where it was.
"""

import contextlib
import signal
import time
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Final

from ncsim_core.engine.simulation import Simulation
from ncsim_core.errors import PluginError
from ncsim_core.memory import limited_memory

GRACE_s: Final = 1.0
"""What a call that does not return gets beyond the limit."""


class StuckError(BaseException):
    """Time is up in the middle of a call; no ``Exception``, so that no plug-in swallows it."""


@dataclass(frozen=True)
class Guard:
    """When to give up on a run, apart from what happens in it.

    Args:
        wall_s: Seconds on the clock.
        memory_MB: What the run may take beyond what the program has at its start.
    """

    wall_s: float | None = None
    memory_MB: float | None = None

    @contextlib.contextmanager
    def watching(self) -> Iterator[float]:
        """Limit what happens in the block; give the time of the clock at which it is over.

        Raises:
            PluginError: A component did not return while the run was being built.
        """
        deadline_s = time.monotonic() + (float("inf") if self.wall_s is None else self.wall_s)
        with limited_memory(self.memory_MB), _alarm(self.wall_s):
            try:
                yield deadline_s
            except StuckError as stuck:
                raise PluginError(self.says(_place(stuck))) from None

    def run(self, simulation: Simulation, deadline_s: float) -> None:
        """Run to the end, or until time is up."""
        if self.wall_s is None:
            simulation.run()
            return
        try:
            while simulation.outcome is None and time.monotonic() < deadline_s:
                simulation.step()
            place = ""
        except StuckError as stuck:
            place = _place(stuck)
        if simulation.outcome is None:
            simulation.give_up(self.says(place))

    def says(self, place: str) -> str:
        """Return why the run ended, and where it hung."""
        return f"the limit of {self.wall_s:g} s on the clock{place}"


def _place(stuck: StuckError) -> str:
    frame = traceback.extract_tb(stuck.__traceback__)[-2]  # the last is the alarm's own
    return f"; it was in {frame.name} ({Path(frame.filename).name}:{frame.lineno})"


@contextlib.contextmanager
def _alarm(wall_s: float | None) -> Iterator[None]:
    if wall_s is None or not hasattr(signal, "setitimer"):
        yield
        return
    before = signal.signal(signal.SIGALRM, _interrupt)
    signal.setitimer(signal.ITIMER_REAL, wall_s + GRACE_s)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def _interrupt(number: int, frame: FrameType | None) -> None:
    del number, frame
    raise StuckError
