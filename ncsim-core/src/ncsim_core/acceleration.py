"""Whether functions may be compiled here; looks for numba without starting it, which takes time."""

import os
from functools import cache
from importlib.util import find_spec


def may_compile() -> bool:
    """Return whether numba is installed and ``NCSIM_PURE=1`` does not forbid it."""
    return os.environ.get("NCSIM_PURE", "") != "1" and _has_numba()


@cache
def numba_starts() -> bool:
    """Start numba; return whether that works, beside the numpy that is there, and it compiles."""
    from ncsim_core.compiling import NUMBA

    return NUMBA is not None


@cache
def _has_numba() -> bool:
    return find_spec("numba") is not None
