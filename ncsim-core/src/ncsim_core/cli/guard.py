"""Limits on the clock and on memory, kept even if a plug-in never comes back.

The clock is looked at ten times a second. A component that does not return from a call is
interrupted a moment later, where the system has alarms, and the run says where it was.
"""

import contextlib
import time
from collections.abc import Iterator
from dataclasses import dataclass

from ncsim_core.engine.alarm import GRACE_s, StuckError, alarm
from ncsim_core.engine.simulation import Simulation
from ncsim_core.errors import PluginError
from ncsim_core.memory import limited_memory


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
        interrupted_s = None if self.wall_s is None else self.wall_s + GRACE_s
        with limited_memory(self.memory_MB), alarm(interrupted_s):
            try:
                yield deadline_s
            except StuckError as stuck:
                raise PluginError(self.says(stuck.place)) from None

    def run(self, simulation: Simulation, deadline_s: float) -> None:
        """Run to the end, or until time is up."""
        if self.wall_s is None:
            simulation.run()
            return
        try:
            simulation.run_until(deadline_s)
            place = ""
        except StuckError as stuck:
            place = stuck.place
        if simulation.outcome is None:
            simulation.give_up(self.says(place))

    def says(self, place: str) -> str:
        """Return why the run ended, and where it hung."""
        where = f"; {place}" if place else ""
        return f"the limit of {self.wall_s:g} s on the clock{where}"
