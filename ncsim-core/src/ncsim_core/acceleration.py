"""Whether compiled functions are used; looks for numba without starting it, which takes time.

``NCSIM_PURE=1`` forbids them, ``NCSIM_PURE=0`` has them used from the first run on.
"""

import os
import sys
from functools import cache, cached_property
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from ncsim_core.memory import is_memory_limited

START_us: Final = 2_000_000
"""What it takes to start numba and to read what it has kept, twice over."""


class Payback:
    """Counts what compiled functions would have saved a process, against what they cost.

    Args:
        folder: Of their modules, where numba keeps them.
        compile_us: What it takes to compile them, the first time on a machine.
    """

    def __init__(self, folder: Path, compile_us: int) -> None:
        self._folder = folder
        self._compile_us = compile_us
        self.saved_us = 0

    def is_reached(self, saved_us: int) -> bool:
        """Add what would be saved now; return whether compiled functions should be used.

        Never where memory is limited: what numba needs, some 500 MB, is not the run's.
        """
        if not may_compile() or is_memory_limited():
            return False
        self.saved_us += saved_us
        return self.saved_us >= self._price_us() and numba_starts()

    def _price_us(self) -> int:
        if os.environ.get("NCSIM_PURE") == "0":
            return 0
        start_us = 0 if "numba" in sys.modules else START_us
        return start_us + (0 if self._are_kept else self._compile_us)

    @cached_property
    def _are_kept(self) -> bool:
        kept = self._folder.joinpath("__pycache__").glob("*.nbi")
        return "NUMBA_CACHE_DIR" in os.environ or any(kept)


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
