"""In which form the costliest functions are used: arrays of numpy, or compiled loops.

Both give the same bits, so the choice is one of speed alone. Compiled loops pay for themselves only
in long work, since numba takes seconds to start: they are used from ``WORTH_LOOPS`` steps on,
counted over a process, or at once where numba has been started already.
"""

import os
import sys
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from typing import Final, NamedTuple

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial import attempts, chains, energy, gaps, occupancy, overlap

WORTH_LOOPS: Final = 4000
"""Steps that save, at about 1 ms each, what it takes to start numba and to read its cache."""

_steps_so_far = 0


class Forms(NamedTuple):
    """The functions that there are in two forms; see the modules that define them."""

    attempts_of: Callable[[attempts.Contenders, attempts.Exchange], attempts.Attempts]
    survival: Callable[[gaps.Interferers, gaps.Windows], gaps.Survival]
    joint_stages: Callable[[chains.SideRates, chains.SideRates], FloatArray]
    silenced_by: Callable[[energy.Silencing, FloatArray], energy.Silenced]
    exact_occupancy: Callable[[occupancy.SetTable, FloatArray], occupancy.Occupancy]
    helped_kill: Callable[[overlap.Helped, FloatArray, FloatArray, FloatArray], FloatArray]


ARRAYS: Final = Forms(
    attempts.attempts_of,
    gaps.survival,
    chains.joint_stages,
    energy.silenced_by,
    occupancy.exact_occupancy,
    overlap.helped_kill,
)


@cache
def compiled_loops() -> Forms:
    """Return the compiled form; plain loops, which are slow, without numba."""
    from ncsim_wifi.spatial.compiled.attempts import attempts_of
    from ncsim_wifi.spatial.compiled.chains import joint_stages
    from ncsim_wifi.spatial.compiled.energy import silenced_by
    from ncsim_wifi.spatial.compiled.gaps import survival
    from ncsim_wifi.spatial.compiled.occupancy import exact_occupancy
    from ncsim_wifi.spatial.compiled.overlap import helped_kill

    return Forms(attempts_of, survival, joint_stages, silenced_by, exact_occupancy, helped_kill)


def forms_for(steps: int) -> Forms:
    """Return the form that is best for this many steps, after those so far.

    Args:
        steps: Steps of fixed points that are about to be made.
    """
    global _steps_so_far  # noqa: PLW0603 - a matter of the process, and of speed only
    _steps_so_far += steps
    is_worth = "numba" in sys.modules or _steps_so_far >= WORTH_LOOPS
    return compiled_loops() if is_worth and may_compile() else ARRAYS


def may_compile() -> bool:
    """Return whether numba is installed and ``NCSIM_PURE=1`` does not forbid it."""
    return os.environ.get("NCSIM_PURE", "") != "1" and _has_numba()


@cache
def _has_numba() -> bool:
    return find_spec("numba") is not None
