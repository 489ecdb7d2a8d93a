"""Ends a call that does not return once time on the clock is up, and says where it was.

Needs a system with alarms and the main thread; elsewhere nothing is interrupted. An extension in C
is interrupted when it returns.
"""

import contextlib
import signal
import threading
import traceback
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import FrameType
from typing import Final, NamedTuple

from ncsim_core.contracts.routing_model import RouteTable
from ncsim_core.models import ComponentIdentity
from ncsim_core.registry.building import contract_of

GRACE_s: Final = 1.0
"""What a call that does not return gets beyond the limit."""
LONGEST_s: Final = 1e8
"""Three years; clocks of systems end somewhere beyond."""
ASKING: Final = frozenset({"asked", "imported", "built", "_rated"})
"""Functions in which a component is called; their argument ``identity`` says which."""


class StuckError(BaseException):
    """Time is up in the middle of a call; no ``Exception``, so that no plug-in swallows it."""

    @property
    def place(self) -> str:
        """Return where it was, and within which question to which component."""
        frames = [frame for frame, _ in traceback.walk_tb(self.__traceback__)][:-1]
        at = traceback.extract_tb(self.__traceback__)[-2]  # the last is the alarm's own
        return f"it was in {at.name} ({Path(at.filename).name}:{at.lineno}){_question(frames)}"


@contextlib.contextmanager
def alarm(wall_s: float | None) -> Iterator[None]:
    """Interrupt what happens in the block once it has taken so many seconds.

    Args:
        wall_s: Seconds on the clock; ``None`` is no limit.

    Raises:
        StuckError: Time was up.
    """
    is_main = threading.current_thread() is threading.main_thread()
    if wall_s is None or not is_main or not hasattr(signal, "setitimer"):
        yield
        return
    before = signal.signal(signal.SIGALRM, _interrupt)
    signal.setitimer(signal.ITIMER_REAL, min(wall_s, LONGEST_s))
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def _interrupt(number: int, frame: FrameType | None) -> None:
    del number, frame
    raise StuckError


class _Asked(NamedTuple):
    """A component that is being asked something: its kind, and how errors name it."""

    kind: str
    label: str


def _question(frames: Sequence[FrameType]) -> str:
    """Return which component was asked what, as far as the calls from outside to inside tell."""
    who: _Asked | None = None
    method, methods = "", frozenset[str]()
    for frame in frames:
        name = frame.f_code.co_name
        asked = _asked_in(frame)
        if asked is not None:
            who, method, methods = asked, "", _methods_of(asked.kind)
        elif name in methods:
            method = f"{name} of "
    return "" if who is None else f", within {method}{who.label}"


def _asked_in(frame: FrameType) -> _Asked | None:
    given = frame.f_locals
    owner = given.get("self")
    if isinstance(owner, RouteTable):
        return _Asked("routing_model", str(getattr(owner, "_label", "")))
    is_asking = frame.f_code.co_name in ASKING
    found = given.get("identity") if is_asking else getattr(owner, "_who", None)
    return _Asked(found.kind, str(found)) if isinstance(found, ComponentIdentity) else None


def _methods_of(kind: str) -> frozenset[str]:
    names = (name for name in dir(contract_of(kind)) if not name.startswith("_"))
    return frozenset({*names, "__init__", "__len__"})
