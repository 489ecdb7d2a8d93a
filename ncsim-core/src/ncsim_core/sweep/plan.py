"""A sweep as it is carried out: everything that its runs are determined by, in plain data.

A plan needs no file any more, so that it can be sent to workers that share no disk.
"""

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from functools import cached_property
from typing import Any

from ncsim_core.sweep.axes import Axis, Run, combinations
from ncsim_core.sweep.where import condition

SEED_BYTES = 4


@dataclass(frozen=True)
class Base:
    """What all runs have in common, before any value of an axis is put in.

    Args:
        name: The scenario's name.
        network: Rows as in a scenario file, ``{type: ...}`` of a generator, or ``{file: ...}``.
        dags: Likewise; rows are a list.
        config: Rows under ``config``.
        files: By name, the ``scenario`` part of each file that network or DAGs may come from.
    """

    name: str
    network: Mapping[str, Any]
    dags: Any
    config: Mapping[str, Any]
    files: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)


@dataclass(frozen=True)
class RunLimits:
    """When to give up on one run.

    Args:
        wall_s: Time on the clock. A worker that does not even answer is stopped.
        max_events: Events.
        max_time_s: Simulated time.
        memory_MB: What the run may take beyond what its worker has.
    """

    wall_s: float | None = None
    max_events: int | None = None
    max_time_s: float | None = None
    memory_MB: float | None = None


@dataclass(frozen=True)
class SweepPlan:
    """A checked sweep.

    Args:
        name: What people call it.
        description: Free text.
        base: What all runs have in common.
        axes: What is varied.
        where: Conditions that every run meets.
        seeds: The replications.
        pair: Columns along which runs are compared, and so share their draws; runs that differ
            elsewhere have draws of their own. ``None`` lets all runs of a seed share them.
        limits: When to give up on one run.
    """

    name: str
    description: str
    base: Base
    axes: tuple[Axis, ...]
    where: tuple[str, ...] = ()
    seeds: tuple[int, ...] = (42,)
    pair: tuple[str, ...] | None = None
    limits: RunLimits = RunLimits()

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """Return the paths that are varied, in file order."""
        return tuple(path for axis in self.axes for path in axis.paths)

    def runs(self) -> Iterator[Run]:
        """Yield all runs, those that share a network together.

        Raises:
            ConditionError: A condition does not fit the values.
        """
        conditions = [condition(text, self.columns) for text in self.where]
        for run in combinations(self.axes, self.seeds):
            values = self.values_of(run) if conditions else {}
            if all(is_wanted(values) for is_wanted in conditions):
                yield run

    def values_of(self, run: Run) -> dict[str, Any]:
        """Return the varied values of a run by column."""
        return dict(zip(self.columns, run.values, strict=True))

    def draw_seed(self, run: Run) -> int:
        """Return the seed of all random streams of a run.

        Runs that differ only in paired columns get the same one.
        """
        if self.pair is None:
            return run.seed
        own = {
            path: value
            for path, value in zip(self.columns, run.values, strict=True)
            if path not in self.pair
        }
        if not own:
            return run.seed
        digest = hashlib.sha256(canonical([run.seed, own]).encode()).digest()
        return int.from_bytes(digest[:SEED_BYTES], "big")

    @property
    def repeats_itself(self) -> bool:
        """Return whether several seeds share one network and one workload, made by no generator."""
        parts = [self.base.network, self.base.dags]
        is_made = any(isinstance(part, Mapping) and "type" in part for part in parts)
        is_varied = any(axis.part != "config" for axis in self.axes)
        return len(self.seeds) > 1 and not is_made and not is_varied

    def to_json(self) -> str:
        """Return the plan as text that ``plan_from_json`` reads."""
        return canonical(asdict(self))

    @cached_property
    def digest(self) -> str:
        """Return what two plans with the same runs in the same columns have in common."""
        runs = {
            "base": asdict(self.base),
            "axes": [[axis.paths, axis.levels] for axis in self.axes],
            "where": self.where,
            "seeds": self.seeds,
            "pair": self.pair,
        }
        return hashlib.sha256(canonical(runs).encode()).hexdigest()


def plan_from_json(text: str) -> SweepPlan:
    """Return the plan that ``to_json`` wrote."""
    row = json.loads(text)
    return SweepPlan(
        row["name"],
        row["description"],
        Base(**row["base"]),
        tuple(
            Axis(
                tuple(each["paths"]),
                tuple(map(tuple, each["levels"])),
                tuple(map(tuple, each["places"])),
            )
            for each in row["axes"]
        ),
        tuple(row["where"]),
        tuple(row["seeds"]),
        None if row["pair"] is None else tuple(row["pair"]),
        RunLimits(**row["limits"]),
    )


def canonical(data: object) -> str:
    """Return plain data as JSON text that depends on nothing but the data.

    >>> canonical({"b": 1, "a": (2.0, None)})
    '{"a":[2.0,null],"b":1}'
    """
    return json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)
