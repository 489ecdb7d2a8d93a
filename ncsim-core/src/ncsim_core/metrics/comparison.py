"""What changed between two runs, and why: configuration first, then tasks and transfers.

Tasks and dependencies are matched by the names of their DAG and themselves.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

from ncsim_core.metrics.losses import Part, service_parts_us
from ncsim_core.metrics.settings import Difference, differences
from ncsim_core.metrics.statistics import regret_of, slowdown
from ncsim_core.trace.run_trace import RunTask, RunTrace, RunTransfer
from ncsim_core.units import s_from_us

K = TypeVar("K")
V = TypeVar("V")


@dataclass(frozen=True)
class TaskChange:
    """What changed for a task.

    Args:
        label: Names of its DAG and itself.
        first_node: Node in the first run, ``None`` if it was not placed.
        second_node: Node in the second run.
        ready_us: By how much later its inputs were there.
        wait_us: By how much longer it waited for its node.
        compute_us: By how much longer it ran.
    """

    label: str
    first_node: str | None
    second_node: str | None
    ready_us: int
    wait_us: int
    compute_us: int

    @property
    def ended_us(self) -> int:
        """Return by how much later it ended."""
        return self.ready_us + self.wait_us + self.compute_us

    @property
    def why(self) -> str:
        """Return the main cause in words."""
        reasons = {
            "inputs": self.ready_us,
            "queue": self.wait_us,
            "compute": self.compute_us,
        }
        return _main_cause(reasons, is_moved=self.first_node != self.second_node)


@dataclass(frozen=True)
class TransferChange:
    """What changed for a transfer.

    Args:
        label: Names of its DAG and of the tasks at its ends.
        first_route: Links in the first run; empty if nothing travelled.
        second_route: Links in the second run.
        parts: By part, how much more time it took.
    """

    label: str
    first_route: tuple[str, ...]
    second_route: tuple[str, ...]
    parts: Mapping[Part, int]

    @property
    def took_us(self) -> int:
        """Return by how much longer it took from its producer's end to its last byte."""
        return sum(self.parts.values())

    @property
    def why(self) -> str:
        """Return the main cause in words."""
        reasons = {str(part): change_us for part, change_us in self.parts.items()}
        return _main_cause(reasons, is_moved=self.first_route != self.second_route)


@dataclass(frozen=True)
class Comparison:
    """What changed from a first run to a second.

    Args:
        differences: Settings that differ.
        first_status: How the first ended.
        second_status: How the second ended.
        first_makespan_s: ``None`` unless it completed.
        second_makespan_s: Likewise.
        tasks: Tasks that both ran and that changed, in order of the first run.
        transfers: Dependencies that both delivered and that changed.
        unmatched: What only one of the runs did, in words.
    """

    differences: tuple[Difference, ...]
    first_status: str
    second_status: str
    first_makespan_s: float | None
    second_makespan_s: float | None
    tasks: tuple[TaskChange, ...]
    transfers: tuple[TransferChange, ...]
    unmatched: tuple[str, ...]

    @property
    def makespan_ratio(self) -> float | None:
        """Return the second makespan over the first; ``None`` unless both completed."""
        return slowdown(self.second_makespan_s, self.first_makespan_s)

    @property
    def regrets(self) -> tuple[float | None, float | None]:
        """Return what taking the first, and the second, costs relative to the better of the two."""
        makespans_s = {0: self.first_makespan_s, 1: self.second_makespan_s}
        return regret_of(0, makespans_s), regret_of(1, makespans_s)


def compare_runs(first: RunTrace, second: RunTrace) -> Comparison:
    """Return what changed from ``first`` to ``second``."""
    tasks = [_task_table(run) for run in (first, second)]
    transfers = [_transfer_table(run) for run in (first, second)]
    return Comparison(
        differences=tuple(differences(first, second)),
        first_status=first.end.status,
        second_status=second.end.status,
        first_makespan_s=_makespan_s(first),
        second_makespan_s=_makespan_s(second),
        tasks=tuple(
            _present(
                _task_change(_label(key), one, other, first, second)
                for key, one, other in _matched(*tasks)
            )
        ),
        transfers=tuple(
            _present(
                _transfer_change(_label(key), one, other, first, second)
                for key, one, other in _matched(*transfers)
            )
        ),
        unmatched=(*_unmatched("task", *tasks), *_unmatched("dependency", *transfers)),
    )


def _makespan_s(run: RunTrace) -> float | None:
    return None if run.end.makespan_us is None else s_from_us(run.end.makespan_us)


def _task_table(run: RunTrace) -> dict[tuple[str, ...], RunTask]:
    return {(run.dags[task.dag].id, task.id): task for task in run.tasks}


def _transfer_table(run: RunTrace) -> dict[tuple[str, ...], RunTransfer]:
    return {
        (run.dags[each.dag].id, run.tasks[each.source].id, run.tasks[each.target].id): each
        for each in run.transfers
    }


def _label(key: tuple[str, ...]) -> str:
    dag, *names = key
    return f"{dag}/{' -> '.join(names)}"


def _matched(first: Mapping[K, V], second: Mapping[K, V]) -> Iterator[tuple[K, V, V]]:
    for key, one in first.items():
        if key in second:
            yield key, one, second[key]


def _present(changes: Iterable[V | None]) -> Iterator[V]:
    return (change for change in changes if change is not None)


def _unmatched(
    what: str, first: Mapping[tuple[str, ...], object], second: Mapping[tuple[str, ...], object]
) -> Iterator[str]:
    yield from (f"{what} {_label(key)}: only in the first" for key in first if key not in second)
    yield from (f"{what} {_label(key)}: only in the second" for key in second if key not in first)


def _task_change(
    label: str, one: RunTask, other: RunTask, first: RunTrace, second: RunTrace
) -> TaskChange | None:
    before, after = _task_times_us(one), _task_times_us(other)
    nodes = _node_id(one, first), _node_id(other, second)
    if before is None or after is None or (before == after and nodes[0] == nodes[1]):
        return None
    ready_us, wait_us, compute_us = (b - a for a, b in zip(before, after, strict=True))
    return TaskChange(label, *nodes, ready_us, wait_us, compute_us)


def _task_times_us(task: RunTask) -> tuple[int, int, int] | None:
    """Return when it was ready, how long it waited and how long it ran; ``None`` if it did not."""
    if task.ready_us is None or task.started_us is None or task.ended_us is None:
        return None
    return task.ready_us, task.started_us - task.ready_us, task.ended_us - task.started_us


def _node_id(task: RunTask, run: RunTrace) -> str | None:
    return None if task.node is None else run.nodes[task.node].id


def _transfer_change(
    label: str, one: RunTransfer, other: RunTransfer, first: RunTrace, second: RunTrace
) -> TransferChange | None:
    before, after = _transfer_parts_us(one, first), _transfer_parts_us(other, second)
    routes = _link_ids(one, first), _link_ids(other, second)
    if before is None or after is None or (before == after and routes[0] == routes[1]):
        return None
    changes = {part: after.get(part, 0) - before.get(part, 0) for part in Part}
    parts = {part: change_us for part, change_us in changes.items() if change_us}
    return TransferChange(label, *routes, parts)


def _transfer_parts_us(transfer: RunTransfer, run: RunTrace) -> dict[Part, int] | None:
    if transfer.is_local:
        return {}
    if transfer.created_us is None or transfer.started_us is None or transfer.ended_us is None:
        return None
    latency_us = transfer.started_us - transfer.created_us
    return {Part.LATENCY: latency_us} | service_parts_us(transfer, run)


def _link_ids(transfer: RunTransfer, run: RunTrace) -> tuple[str, ...]:
    return tuple(run.links[link].id for link in transfer.route)


def _main_cause(changes_us: Mapping[str, int], *, is_moved: bool) -> str:
    """Return the change that pulls hardest in the direction of the sum."""
    total_us = sum(changes_us.values())
    moved = "moved" if is_moved else ""
    if not any(changes_us.values()):
        return moved or "unchanged"
    name = max(changes_us, key=lambda each: changes_us[each] * (1 if total_us >= 0 else -1))
    cause = f"{'more' if changes_us[name] > 0 else 'less'} {name}"
    if name == "inputs":
        cause = f"inputs {'later' if changes_us[name] > 0 else 'earlier'}"
    return f"{moved}, {cause}" if moved else cause
