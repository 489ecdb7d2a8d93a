"""How a run ends: a status, not an exception."""

from dataclasses import dataclass
from enum import StrEnum

from ncsim_core.units import Instant, s_from_us


class RunStatus(StrEnum):
    """Why a run stopped; only a completed run has a makespan."""

    COMPLETED = "completed"
    """Every task has ended."""
    BLOCKED_WIRELESS = "blocked_wireless"
    """Nothing is left to happen, but transfers wait at zero rate."""
    UNROUTABLE = "unroutable"
    """A dependency between two nodes has no usable route."""
    LIMIT_REACHED = "limit_reached"
    """A limit on events or on simulated time was reached."""
    FAILED = "failed"
    """A component failed, or does not cover this scenario."""


@dataclass(frozen=True)
class Outcome:
    """How and when a run ended.

    Args:
        status: Why it stopped.
        ended_us: Time of the last event that was handled.
        makespan_us: When the last task ended; ``None`` unless the run completed.
        events: Events handled.
        detail: What to know about an end other than ``completed``; empty otherwise.
    """

    status: RunStatus
    ended_us: Instant
    makespan_us: Instant | None
    events: int
    detail: str = ""

    @property
    def makespan_s(self) -> float | None:
        """Return the makespan in seconds, ``None`` unless the run completed."""
        return None if self.makespan_us is None else s_from_us(self.makespan_us)
