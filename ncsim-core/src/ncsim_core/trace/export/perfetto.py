"""Chrome trace-event JSON for ui.perfetto.dev: tasks by node, transfers, throughput of links.

Slices on one track may not overlap there. Tasks of one node never do; transfers do, so they
are packed into as many lanes as are needed at once. Arrows lead from a task over its transfers to
the tasks that wait for them; counters show what each link serves.

Source: "Trace Event Format", Google, phases X, i, C, s, t, f and M.
"""

import heapq
import math
from collections.abc import Iterator, Mapping
from itertools import groupby
from operator import itemgetter
from typing import Final, TypeAlias

from ncsim_core.trace.encoding import to_json
from ncsim_core.trace.run_trace import RunTask, RunTrace, RunTransfer

TraceEvent: TypeAlias = dict[str, object]

NODES: Final = 1
TRANSFERS: Final = 2
LINKS: Final = 3

_PROCESSES: Final = {NODES: "nodes", TRANSFERS: "transfers", LINKS: "links"}


def perfetto_text(run: RunTrace) -> str:
    """Return a run as one JSON document, an event per line."""
    about = to_json({"scenario": run.header.scenario, "status": run.end.status})
    events = ",\n".join(map(to_json, perfetto_events(run)))
    return f'{{"displayTimeUnit":"ms","otherData":{about},"traceEvents":[\n{events}\n]}}\n'


def perfetto_events(run: RunTrace) -> Iterator[TraceEvent]:
    """Yield the events of a run; times in microseconds."""
    lanes = pack_lanes(run)
    yield from _names(run, lane_count=max(lanes.values(), default=-1) + 1)
    for task in run.tasks:
        if task.started_us is not None and task.node is not None:
            yield _task_slice(task, run)
    for transfer in run.transfers:
        yield from _transfer_slice(transfer, lanes, run)
        yield from _arrow(transfer, lanes, run)
    yield from _throughput(run)


def pack_lanes(run: RunTrace) -> dict[int, int]:
    """Return the lane of each transfer that began: the lowest that is free when it begins."""
    begun = [each for each in run.transfers if each.started_us is not None]
    free: list[int] = []
    busy: list[tuple[int, int]] = []
    lanes: dict[int, int] = {}
    for transfer in sorted(begun, key=lambda each: (each.started_us or 0, each.number)):
        while busy and busy[0][0] <= (transfer.started_us or 0):
            heapq.heappush(free, heapq.heappop(busy)[1])
        lane = heapq.heappop(free) if free else len(busy)
        lanes[transfer.number] = lane
        heapq.heappush(busy, (_end_us(transfer.ended_us, run), lane))
    return lanes


def _end_us(instant: int | None, run: RunTrace) -> int:
    return run.end.ended_us if instant is None else instant


def _names(run: RunTrace, lane_count: int) -> Iterator[TraceEvent]:
    for process, name in _PROCESSES.items():
        yield _metadata("process_name", process, 0, name)
    for number, node in enumerate(run.nodes):
        yield _metadata("thread_name", NODES, number, node.id)
    for lane in range(lane_count):
        yield _metadata("thread_name", TRANSFERS, lane, f"lane {lane}")


def _metadata(kind: str, process: int, thread: int, name: str) -> TraceEvent:
    return {"ph": "M", "name": kind, "pid": process, "tid": thread, "args": {"name": name}}


def _task_slice(task: RunTask, run: RunTrace) -> TraceEvent:
    start_us = task.started_us or 0
    waited_us = start_us - (start_us if task.ready_us is None else task.ready_us)
    args = {"dag": run.dags[task.dag].id, "cost": task.cost, "queue_wait_us": waited_us}
    name = run.task_label(task.number)
    return _slice(name, NODES, task.node or 0, (start_us, _end_us(task.ended_us, run)), args)


def _slice(
    name: str, process: int, thread: int, span_us: tuple[int, int], args: TraceEvent
) -> TraceEvent:
    """Return a slice, or a mark if it takes no time, as empty slices upset their neighbours."""
    start_us, end_us = span_us
    event = {"name": name, "pid": process, "tid": thread, "ts": start_us, "args": args}
    if end_us > start_us:
        return {"ph": "X", "dur": end_us - start_us, **event}
    return {"ph": "i", "s": "t", **event}


def _transfer_slice(
    transfer: RunTransfer, lanes: Mapping[int, int], run: RunTrace
) -> Iterator[TraceEvent]:
    if transfer.started_us is None:
        return
    args: TraceEvent = {
        "size_MB": transfer.size_MB,
        "route": [run.links[link].id for link in transfer.route],
        "dag": run.dags[transfer.dag].id,
    }
    span_us = transfer.started_us, _end_us(transfer.ended_us, run)
    name = run.transfer_label(transfer.number)
    yield _slice(name, TRANSFERS, lanes[transfer.number], span_us, args)


def _arrow(transfer: RunTransfer, lanes: Mapping[int, int], run: RunTrace) -> Iterator[TraceEvent]:
    """Yield an arrow from producer over transfer to waiting task, when all three took time."""
    source, target = run.tasks[transfer.source], run.tasks[transfer.target]
    spans_us = [
        (each.started_us, each.ended_us) for each in (source, transfer, target) if each.ended_us
    ]
    if len(spans_us) < 3 or any(start == end for start, end in spans_us):  # noqa: PLR2004 - three ends
        return
    stops = (
        ("s", NODES, source.node, (source.ended_us or 1) - 1),
        ("t", TRANSFERS, lanes[transfer.number], transfer.started_us),
        ("f", NODES, target.node, target.started_us),
    )
    for phase, process, thread, at_us in stops:
        event = {"ph": phase, "bp": "e", "id": transfer.number, "name": "data", "cat": "data"}
        yield {**event, "pid": process, "tid": thread, "ts": at_us}


def _throughput(run: RunTrace) -> Iterator[TraceEvent]:
    """Yield what each link serves whenever that changes, if rates were recorded."""
    for link, changes in enumerate(_rate_changes_by_link(run)):
        name = f"{run.links[link].id} MB/s"
        rates: dict[int, float] = {}
        for at_us, group in groupby(sorted(changes, key=itemgetter(0)), key=itemgetter(0)):
            rates.update((transfer, rate_MBps) for _, transfer, rate_MBps in group)
            total_MBps = math.fsum(rates.values())
            yield {"ph": "C", "name": name, "pid": LINKS, "ts": at_us, "args": {"MB/s": total_MBps}}


def _rate_changes_by_link(run: RunTrace) -> list[list[tuple[int, int, float]]]:
    """Return for each link (time, transfer, new rate), of one transfer in the order they came."""
    changes: list[list[tuple[int, int, float]]] = [[] for _ in run.links]
    for transfer in run.transfers:
        steps = [(step.at_us, transfer.number, step.rate_MBps) for step in transfer.steps]
        if steps:
            steps.append((_end_us(transfer.ended_us, run), transfer.number, 0.0))
        for link in transfer.route:
            changes[link] += steps
    return changes
