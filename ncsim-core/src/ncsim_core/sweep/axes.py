"""What a sweep varies: axes of values, and the walk through all their combinations."""

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, TypeAlias

from ncsim_core.scenario.faults import Path, Problem, shown

Value: TypeAlias = Any
"""Plain data that a parameter takes."""

Part: TypeAlias = Literal["network", "dags", "config"]

MAX_LEVELS = 10_000
"""Values of all axes together; each is tried out when the file is read."""
_ROUNDING_DIGITS = 12


@dataclass(frozen=True)
class Axis:
    """One dimension of a sweep.

    Args:
        paths: What it sets: one parameter, or several that go together (``zip``).
        levels: The values that it takes in turn, one for each of the paths.
        places: Where in the sweep file each path's values stand.
    """

    paths: tuple[str, ...]
    levels: tuple[tuple[Value, ...], ...]
    places: tuple[Path, ...]

    @property
    def part(self) -> Part:
        """Return the part of a scenario that it changes; the widest, if there are several."""
        parts = {part_of(path) for path in self.paths}
        return "network" if "network" in parts else "dags" if "dags" in parts else "config"


class Run(NamedTuple):
    """One run of a sweep.

    Args:
        number: Its place in the order of the file, seeds innermost.
        values: What each column of the plan takes.
        seed: The replication.
    """

    number: int
    values: tuple[Value, ...]
    seed: int


def part_of(path: str) -> Part:
    """Return the part of a scenario that a path leads into.

    >>> part_of("network.size"), part_of("rf.tx_power_dBm")
    ('network', 'config')
    """
    head = path.partition(".")[0]
    if head == "network":
        return "network"
    return "dags" if head == "dags" else "config"


def levels_of(values: Value, place: Path) -> tuple[Sequence[Value], list[Problem]]:
    """Return the values that a list or a range in a sweep file stands for."""
    if isinstance(values, list) and len(values) > MAX_LEVELS:
        return [], [Problem(place, f"has more than {MAX_LEVELS} values")]
    if isinstance(values, list):
        return values, []
    if not isinstance(values, Mapping):
        return [], [Problem(place, "must be a list of values or a range", shown(values))]
    try:
        return _range(values), []
    except (ValueError, OverflowError) as error:
        return [], [Problem(place, str(error))]


def repeated(values: Sequence[Value]) -> Iterator[int]:
    """Yield where a value stands that stands there before: its runs would count double.

    >>> list(repeated([3, 4, 3]))
    [2]
    """
    seen: set[str] = set()
    for number, value in enumerate(values):
        text = json.dumps(value, sort_keys=True)
        if text in seen:
            yield number
        seen.add(text)


def combinations(axes: Sequence[Axis], seeds: Sequence[int]) -> Iterator[Run]:
    """Yield every combination of levels and seeds.

    The order is one in which runs that share a network follow one another: network axes are
    outermost, then seeds, then DAGs, then models. ``number`` restores the order of the file.
    """
    order = sorted(
        range(len(axes)), key=lambda i: ("network", "dags", "config").index(axes[i].part)
    )
    split = sum(axis.part == "network" for axis in axes)
    weights = _weights(axes, len(seeds))
    for outer in _indices([axes[i] for i in order[:split]]):
        for replica, seed in enumerate(seeds):
            for inner in _indices([axes[i] for i in order[split:]]):
                at = dict(zip(order, (*outer, *inner), strict=True))
                number = replica + sum(weights[i] * level for i, level in at.items())
                values = tuple(v for i, axis in enumerate(axes) for v in axis.levels[at[i]])
                yield Run(number, values, seed)


def _weights(axes: Sequence[Axis], seeds: int) -> list[int]:
    """Return by how much a step along each axis raises the number of a run."""
    weights, weight = [], seeds
    for axis in reversed(axes):
        weights.append(weight)
        weight *= len(axis.levels)
    return weights[::-1]


def _indices(axes: Sequence[Axis]) -> Iterator[tuple[int, ...]]:
    """Yield the level numbers of all combinations, the last axis fastest."""
    if not axes:
        yield ()
        return
    for first in range(len(axes[0].levels)):
        for rest in _indices(axes[1:]):
            yield (first, *rest)


def _range(row: Mapping[str, Any]) -> list[Value]:
    """Return the values of ``{from, to, step}`` or ``{from, to, count, scale}``, ends included.

    Raises:
        ValueError: The range is empty or endless.

    >>> _range({"from": 10, "to": 20, "step": 5})
    [10, 15, 20]
    >>> _range({"from": 1, "to": 100, "count": 3, "scale": "log"})
    [1.0, 10.0, 100.0]
    """
    start, end = row["from"], row["to"]
    if "count" in row and "step" in row:
        raise ValueError("give a step or a count, not both")
    if "scale" in row and "count" not in row:
        raise ValueError("a scale needs a count of values")
    if "count" in row and row["count"] > MAX_LEVELS:
        raise ValueError(f"has more than {MAX_LEVELS} values")
    if "count" in row:
        return _spread(start, end, row["count"], row.get("scale", "linear"))
    step = row.get("step", 1)
    steps = math.nan if step == 0 else (end - start) / step
    if math.isnan(steps) or steps < 0:
        raise ValueError(f"a step of {step} does not lead from {start} to {end}")
    if steps >= MAX_LEVELS:
        raise ValueError(f"has more than {MAX_LEVELS} values")
    steps = math.floor(steps + 1e-9)
    return [_tidy(start + number * step) for number in range(steps + 1)]


def _spread(start: float, end: float, count: int, scale: str) -> list[Value]:
    if scale == "log":
        if start <= 0 or end <= 0:
            raise ValueError("a logarithmic range needs ends above 0")
        logs = _spread(math.log10(start), math.log10(end), count, "linear")
        return [float(start), *(_tidy(10**each) for each in logs[1:-1]), float(end)][:count]
    gap = (end - start) / (count - 1) if count > 1 else 0.0
    return [_tidy(start + number * gap) for number in range(count)]


def _tidy(value: float) -> float:
    """Return a number without the dust of floating point: 0.3, not 0.30000000000000004."""
    if isinstance(value, int):
        return value
    return float(f"{value:.{_ROUNDING_DIGITS}g}")
