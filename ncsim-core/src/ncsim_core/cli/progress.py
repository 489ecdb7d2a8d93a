"""A line on the terminal that says how far long work is; silent when nobody looks."""

import sys
import time
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from typing_extensions import override

from ncsim_core.engine.events import TASK_COMPLETE
from ncsim_core.engine.observer import Batch, BatchObserver
from ncsim_core.units import s_from_us

if TYPE_CHECKING:
    from ncsim_core.engine.outcome import Outcome
    from ncsim_core.engine.setup import Setup

QUIET_FOR_s: Final = 0.5
REDRAW_EVERY_s: Final = 0.1
MARK_EVERY_s: Final = 0.5
LATELY_s: Final = 10.0


class ProgressLine:
    """A line on stderr that is drawn over itself; nothing if stderr is no terminal.

    Args:
        is_wanted: ``False`` keeps it silent on a terminal too.
    """

    def __init__(self, *, is_wanted: bool = True) -> None:
        self.is_shown = is_wanted and sys.stderr.isatty()
        self._next_draw_s = time.monotonic() + QUIET_FOR_s
        self._width = 0

    def show(self, text: str) -> None:
        """Draw ``text``, unless the last line was drawn just now."""
        if not self.is_shown or time.monotonic() < self._next_draw_s:
            return
        self._draw(text)
        self._next_draw_s = time.monotonic() + REDRAW_EVERY_s

    def clear(self) -> None:
        """Take the line away."""
        if self._width:
            self._draw("")
            sys.stderr.write("\r")
            self._width = 0

    def _draw(self, text: str) -> None:
        sys.stderr.write("\r" + text.ljust(self._width))
        sys.stderr.flush()
        self._width = len(text)


class Pace:
    """How many per second were done lately, so that a burst at the start is soon forgotten.

    Args:
        clock: Seconds; for tests.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._marks: deque[tuple[float, int]] = deque([(clock(), 0)])

    def at(self, done: int) -> float:
        """Return how many per second were done over the last seconds, with ``done`` so far."""
        now_s = self._clock()
        if now_s - self._marks[-1][0] >= MARK_EVERY_s:
            self._marks.append((now_s, done))
        while len(self._marks) > 1 and now_s - self._marks[1][0] >= LATELY_s:
            self._marks.popleft()
        since_s, before = self._marks[0]
        return (done - before) / (now_s - since_s) if now_s > since_s else 0.0


class RunProgress(BatchObserver):
    """Shows how many tasks of a run have ended."""

    wants_rates = False

    def __init__(self, line: ProgressLine) -> None:
        self._line = line
        self._total = 0
        self._ended = 0

    @override
    def run_started(self, setup: "Setup") -> None:
        self._total = len(setup.tasks)

    @override
    def events_happened(self, batch: Batch) -> None:
        self._ended += [kind for _, kind, _, _ in batch.events].count(TASK_COMPLETE)
        now_s = s_from_us(batch.events[-1][0])
        self._line.show(f"{self._ended}/{self._total} tasks, {now_s:.3f} s simulated")

    @override
    def run_ended(self, outcome: "Outcome") -> None:
        self._line.clear()
