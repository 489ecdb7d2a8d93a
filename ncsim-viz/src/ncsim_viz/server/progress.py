"""How far a run is, told from its growing trace."""

import re
from typing import Final

from ncsim_core.units import s_from_us

from ncsim_viz.server.library import Library
from ncsim_viz.server.tail import START, Records, Restart, follow
from ncsim_viz.server.tracing import source_of

TASK_ENDED: Final = b'"k":"end"'  # cannot occur in a name, whose quotes are escaped
_TIME = re.compile(rb'\{"t":(\d+)')


class Progress:
    """Counts the tasks that have ended in a trace, reading on where it left off."""

    def __init__(self) -> None:
        self._ended = 0
        self._now_us = 0
        self._mark = START

    def to_json(self, tasks: int) -> dict[str, object]:
        """Return the progress ready for JSON.

        Args:
            tasks: How many there are.
        """
        return {
            "tasks_ended": self._ended,
            "tasks": tasks,
            "simulated_s": s_from_us(self._now_us),
        }

    def look(self, library: Library, run: str) -> None:
        """Take in what has been written since the last look."""
        for step in follow(lambda: source_of(library, run), self._mark):
            if isinstance(step, Restart):
                self._ended = 0
            elif isinstance(step, Records):
                self._take(step)
            else:
                return

    def _take(self, records: Records) -> None:
        self._mark = records.after
        self._ended += records.lines.count(TASK_ENDED)
        last = records.lines[records.lines.rfind(b"\n", 0, -1) + 1 :]
        match = _TIME.match(last)
        if match:
            self._now_us = int(match[1])
