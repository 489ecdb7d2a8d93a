"""Whether a run goes through the compiled loop; its results are the same either way.

The loop pays for itself only in long runs, since numba takes two seconds to start.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Final

from ncsim_core.acceleration import Payback
from ncsim_core.engine.sessions.choice import loads_of
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import State
from ncsim_core.units import Instant

if TYPE_CHECKING:
    from ncsim_core.engine.compiled.compiled_run import CompiledRun

SAVED_us: Final = 8
SAVED_WITH_RADIO_us: Final = 30
"""What the loop saves at a start or finish of a transfer, about."""

PAYBACK: Final = Payback(Path(__file__).parent / "compiled", compile_us=7_000_000)


def compiled_run_of(state: State, setup: Setup, last_us: Instant) -> "CompiledRun | None":
    """Return the run in the compiled loop, if it can be done there and is worth it.

    Args:
        state: Of the run before its first event.
        setup: Of the run.
        last_us: No event after this is handled.
    """
    if not is_possible(state, setup) or not is_worth_compiling(setup):
        return None
    from ncsim_core.engine.compiled.compiled_run import CompiledRun

    return CompiledRun(state, setup, last_us)


def is_possible(state: State, setup: Setup) -> bool:
    """Return whether all that decides in a run is known to the compiled loop.

    That is: links affect each other by tables or not at all, lines on nodes are first in, first
    out, and who watches need not see the state at that time.
    """
    if setup.is_global or setup.decides_routes:
        return False
    tables = setup.models.interference.tables()
    if state.interference is not None and (tables is None or not loads_of(tables).fits):
        return False
    lines_are_plain = all(node.queue.is_first_in_first_out for node in state.nodes)
    return lines_are_plain and not state.observers


def is_worth_compiling(setup: Setup) -> bool:
    """Return whether a run of this length, after those so far, should be compiled."""
    saved_us = SAVED_us if setup.models.interference.tables() is None else SAVED_WITH_RADIO_us
    return PAYBACK.is_reached(saved_us * 2 * len(setup.dependencies))
