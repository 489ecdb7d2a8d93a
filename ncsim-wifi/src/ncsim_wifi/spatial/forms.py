"""In which form steps of the fixed point are made: arrays of numpy, or compiled loops.

Both give the same bits, so the choice is one of speed alone. Compiled loops pay for themselves only
in long work, since numba takes time to start: they are used once the work of a process comes to
``WORTH_LOOPS_us``, or at once where numba has been started already.
"""

import sys
from functools import cache
from typing import Final

from ncsim_core.acceleration import may_compile, numba_starts
from ncsim_core.memory import is_memory_limited

from ncsim_wifi.spatial.solve import FixedPoint

SAVED_us: Final = 70
"""What loops save for each link in a step, about."""

WORTH_LOOPS_us: Final = 2_000_000
"""What has to be saved; it takes half of that to start numba and to read what it has kept."""

_saved_so_far_us = 0


ARRAYS: Final = FixedPoint


@cache
def compiled_loops() -> type[FixedPoint]:
    """Return the compiled form; plain loops, which are slow, without numba."""
    from ncsim_wifi.spatial.compiled.fixed_point import CompiledFixedPoint

    return CompiledFixedPoint


def form_for(steps: int, links: int) -> type[FixedPoint]:
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
