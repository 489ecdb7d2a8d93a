"""How large a sweep may be: what is larger is a slip of the pen, and would fill the memory."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

from ncsim_core.scenario.faults import Path, Problem, shown
from ncsim_core.sweep.axes import MAX_LEVELS, Axis

MAX_AXES: Final = 200
MAX_SEEDS: Final = 1_000_000
MAX_RUNS: Final = 10_000_000

SWEEP: Path = ("sweep",)


def extent_problems(axes: Sequence[Axis], rows: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield that there are too many axes, values, seeds or runs."""
    if len(axes) > MAX_AXES:
        yield Problem(SWEEP, f"varies {len(axes)} things; {MAX_AXES} are allowed")
    levels = sum(len(axis.levels) for axis in axes)
    if levels > MAX_LEVELS:
        yield Problem(SWEEP, f"has {levels} values to vary; {MAX_LEVELS} are allowed")
    given = rows.get("replicate", {}).get("seeds", 1)
    seeds = len(given) if isinstance(given, list | tuple) else int(given)
    if seeds > MAX_SEEDS:
        place = (*SWEEP, "replicate", "seeds")
        yield Problem(place, f"more than {MAX_SEEDS} seeds are not allowed", shown(given))
    elif seeds * math.prod(len(axis.levels) for axis in axes[:MAX_AXES]) > MAX_RUNS:
        yield Problem(SWEEP, f"has more than {MAX_RUNS} runs, conditions aside")
