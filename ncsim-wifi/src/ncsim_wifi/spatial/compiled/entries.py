"""The compiled function that is called from outside, as numba keeps it on disk.

It encloses what stands for its sources: see ``state_of``.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Final
from zlib import crc32

from ncsim_core.compiling import kept_on_disk, state_of

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.compiled import solve
from ncsim_wifi.spatial.compiled.state import State
from ncsim_wifi.spatial.compiled.tables import Tables

Advance = Callable[[Tables, State, int, int], FloatArray]


def loops_of(sources: str) -> Advance:
    """Return the compiled loops.

    Args:
        sources: Stands for what they are compiled from; not empty.
    """

    def advance(tables: Tables, state: State, first: int, stop: int) -> FloatArray:
        assert sources
        return solve.advance(tables, state, first, stop)

    # what numba keeps refers to classes by name: it cannot be read once one of them is gone
    advance.__qualname__ = f"advance_{crc32(sources.encode()):08x}"
    return kept_on_disk(advance)


def _sources() -> str:
    """Return what changes whenever a file does that the loops are compiled from."""
    here = Path(__file__).parent
    files = [*sorted(here.glob("*.py")), *sorted(here.parent.glob("*.py"))]
    files.append(here.parents[1] / "mac" / "timing.py")
    return state_of(files)


ADVANCE: Final = loops_of(_sources())
