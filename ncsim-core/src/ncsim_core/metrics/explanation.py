"""Why the makespan is what it is: the binding chain of a run and what its time went into.

The chain is walked backwards from the task that ended last (the first by number if several did). A
task became ready when its last input arrived (the first dependency by number if several did at that
instant); the chain goes on with the task that produced this input, until a task that waited for
nothing but its DAG's injection. Every microsecond from 0 to the makespan lies in exactly one
part of one item, so the parts sum to the makespan.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from ncsim_core.metrics.losses import Part, service_parts_us
from ncsim_core.trace.records import TraceError
from ncsim_core.trace.run_trace import RunTask, RunTrace, RunTransfer


@dataclass(frozen=True)
class ChainItem:
    """One link of the binding chain.

    Args:
        kind: ``injection``, ``task`` (from ready to end) or ``transfer`` (from the end of its
            producer to its last byte).
        label: Names of DAG, task or dependency.
        place: The node or the links, by id.
        start_us: Where the item before ends.
        end_us: Where the next begins.
        parts: What its time went into; sums to its length.
    """

    kind: Literal["injection", "task", "transfer"]
    label: str
    place: tuple[str, ...]
    start_us: int
    end_us: int
    parts: Mapping[Part, int]


@dataclass(frozen=True)
class Explanation:
    """The binding chain of a run, in order of time, and the sums over its items.

    Args:
        makespan_us: When the last task ended.
        chain: From time 0 to the makespan without a gap.
        totals: For every part, its share of the makespan; sums to it.
    """

    makespan_us: int
    chain: tuple[ChainItem, ...]
    totals: Mapping[Part, int]


def explain_run(run: RunTrace) -> Explanation:
    """Return why the makespan of a completed run is what it is.

    Raises:
        TraceError: The run has no makespan, or its trace contradicts itself (see
            ``ncsim trace check``).
    """
    makespan_us = run.end.makespan_us
    if makespan_us is None:
        detail = f": {run.end.detail}" if run.end.detail else ""
        raise TraceError(f"the run ended {run.end.status} and has no makespan to explain{detail}")
    if not run.tasks:
        return Explanation(0, (), dict.fromkeys(Part, 0))
    chain = tuple(reversed(_chain_backwards(run, makespan_us)))
    totals = dict.fromkeys(Part, 0)
    for item in chain:
        for part, spent_us in item.parts.items():
            totals[part] += spent_us
    if sum(totals.values()) != makespan_us:
        raise TraceError("the trace contradicts itself; see `ncsim trace check`")
    return Explanation(makespan_us, chain, totals)


def _chain_backwards(run: RunTrace, makespan_us: int) -> list[ChainItem]:
    chain: list[ChainItem] = []
    task: RunTask | None = _last_task(run, makespan_us)
    seen: set[int] = set()
    while task is not None:
        if task.number in seen:
            raise TraceError("the trace contradicts itself: its dependencies form a cycle")
        seen.add(task.number)
        chain.append(_task_item(task, run))
        binding = _binding_dependency(task, run)
        if binding is None:
            chain.append(_injection_item(task, run))
            break
        if not binding.is_local:
            chain.append(_transfer_item(binding, run))
        task = run.tasks[binding.source]
    return chain


def _last_task(run: RunTrace, makespan_us: int) -> RunTask:
    for task in run.tasks:
        if task.ended_us == makespan_us:
            return task
    raise TraceError("the trace contradicts itself: no task ends at the makespan")


def _binding_dependency(task: RunTask, run: RunTrace) -> RunTransfer | None:
    """Return the dependency whose data came last, ``None`` for a task without any."""
    incoming = run.incoming[task.number]
    for number in incoming:
        transfer = run.transfers[number]
        arrived_us = transfer.created_us if transfer.is_local else transfer.ended_us
        if arrived_us == task.ready_us:
            return transfer
    if incoming:
        label = run.task_label(task.number)
        raise TraceError(
            f"the trace contradicts itself: no input of {label} arrives when it is ready"
        )
    return None


def _task_item(task: RunTask, run: RunTrace) -> ChainItem:
    if task.ready_us is None or task.started_us is None or task.ended_us is None:
        label = run.task_label(task.number)
        raise TraceError(f"the trace contradicts itself: {label} is needed but did not run")
    parts = {
        Part.QUEUE_WAIT: task.started_us - task.ready_us,
        Part.COMPUTE: task.ended_us - task.started_us,
    }
    node = run.nodes[task.node or 0].id
    return ChainItem(
        "task", run.task_label(task.number), (node,), task.ready_us, task.ended_us, parts
    )


def _transfer_item(transfer: RunTransfer, run: RunTrace) -> ChainItem:
    created_us, started_us, ended_us = transfer.created_us, transfer.started_us, transfer.ended_us
    label = run.transfer_label(transfer.number)
    if created_us is None or started_us is None or ended_us is None:
        raise TraceError(f"the trace contradicts itself: {label} is needed but did not arrive")
    parts = {Part.LATENCY: started_us - created_us} | service_parts_us(transfer, run)
    links = tuple(run.links[link].id for link in transfer.route)
    return ChainItem("transfer", label, links, created_us, ended_us, parts)


def _injection_item(task: RunTask, run: RunTrace) -> ChainItem:
    dag = run.dags[task.dag]
    parts = {Part.INJECTION_WAIT: dag.injected_us}
    return ChainItem("injection", dag.id, (), 0, dag.injected_us, parts)
