"""In which form the costliest functions are used: arrays of numpy, or compiled loops.

Both give the same bits, so the choice is one of speed alone. Compiled loops pay for themselves only
in long work, since numba takes time to start: they are used once the work of a process comes to
``WORTH_LOOPS_us``, or at once where numba has been started already.
"""

import sys
from collections.abc import Callable
from functools import cache
from typing import Final, NamedTuple

from ncsim_core.acceleration import may_compile, numba_starts
from ncsim_core.memory import is_memory_limited

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial import attempts, chains, energy, gaps, occupancy, overlap

SAVED_us: Final = 70
"""What loops save for each link in a step, about."""

WORTH_LOOPS_us: Final = 2_000_000
"""What has to be saved; it takes half of that to start numba and to read what it has kept."""

_saved_so_far_us = 0


class Forms(NamedTuple):
    """The functions that there are in two forms; see the modules that define them."""

    attempts_of: Callable[[attempts.Contenders, attempts.Exchange], attempts.Attempts]
    survival: Callable[[gaps.Interferers, gaps.Windows], gaps.Survival]
    joint_stages: Callable[[chains.SideRates, chains.SideRates], FloatArray]
    stage_means: Callable[[chains.Given, FloatArray], FloatArray]
    silenced_by: Callable[[energy.Silencing, FloatArray], energy.Silenced]
    exact_occupancy: Callable[[occupancy.SetTable, FloatArray], occupancy.Occupancy]
    helped_kill: Callable[
        [overlap.Helped, FloatArray, FloatArray, FloatArray, FloatArray], FloatArray
    ]


ARRAYS: Final = Forms(
    attempts.attempts_of,
    gaps.survival,
    chains.joint_stages,
    chains.stage_means,
    energy.silenced_by,
    occupancy.exact_occupancy,
    overlap.helped_kill,
)


@cache
def compiled_loops() -> Forms:
    """Return the compiled form; plain loops, which are slow, without numba."""
    from ncsim_wifi.spatial.compiled.entries import LOOPS

    return LOOPS


def forms_for(steps: int, links: int) -> Forms:
    """Return the form that is best for some steps, after those so far.

    Args:
        steps: Steps of a fixed point that are about to be made.
        links: Its number of links.

    Returns:
        Arrays where memory is limited: what numba needs, some 500 MB, is not the run's.
    """
    global _saved_so_far_us  # noqa: PLW0603 - a matter of the process, and of speed only
    if not may_compile() or is_memory_limited():
        return ARRAYS
    _saved_so_far_us += SAVED_us * steps * links
    is_worth = "numba" in sys.modules or _saved_so_far_us >= WORTH_LOOPS_us
    return compiled_loops() if is_worth and numba_starts() else ARRAYS
