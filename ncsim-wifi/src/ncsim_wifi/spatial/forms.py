"""In which form steps of the fixed point are made: arrays of numpy, or compiled loops.

Both give the same bits, so the choice is one of speed alone. Compiled loops pay for themselves only
in long work, since numba takes time to start.
"""

from functools import cache
from pathlib import Path
from typing import Final

from ncsim_core.acceleration import Payback

from ncsim_wifi.spatial.solve import FixedPoint

SAVED_us: Final = 70
"""What loops save for each link in a step, about."""

PAYBACK: Final = Payback(Path(__file__).parent / "compiled", compile_us=30_000_000)

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
    """
    return compiled_loops() if PAYBACK.is_reached(SAVED_us * steps * links) else ARRAYS
