"""From records back to the engine's objects, for whoever looks at the state of a run."""

from collections.abc import Iterator, Sequence

import numpy as np

from ncsim_core.engine.boundary import CheckedQueue
from ncsim_core.engine.compiled.arrays import Arrays
from ncsim_core.engine.compiled.event_queue import KIND_SHIFT
from ncsim_core.engine.compiled.layout import NONE
from ncsim_core.engine.compiled.records import Record
from ncsim_core.engine.event_queue import EventQueue
from ncsim_core.engine.events import TRANSFER_COMPLETE, TRANSFER_START
from ncsim_core.engine.sessions.choice import session_of
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import NodeState, State, TaskStatus, Transfer
from ncsim_core.engine.tasks import waiting_task
from ncsim_core.units import Instant, NEVER_us

STATUSES = tuple(TaskStatus)


def unload_counts(arrays: Arrays, state: State) -> None:
    """Bring what is one number up to date."""
    record = arrays.state
    state.now_us, state.events = int(record.now_us), int(record.events)
    state.unfinished_tasks = int(record.unfinished_tasks)
    state.last_task_end_us = int(record.last_task_end_us)


def unload(arrays: Arrays, state: State, setup: Setup) -> None:
    """Bring everything up to date, so that the engine in Python could go on."""
    unload_counts(arrays, state)
    _unload_tasks(arrays["tasks"], state)
    created = arrays["created"][: int(arrays.state.created_count)]
    transfers = transfers_of(created, arrays, state, setup)
    state.transfers = {transfer.number: transfer for transfer in transfers}
    _unload_links(arrays, state, setup)
    _unload_nodes(arrays, state, setup)
    state.queue = _queue(arrays, state.transfers)


def under_way(arrays: Arrays, state: State, setup: Setup) -> Iterator[Transfer]:
    """Give the transfers whose byte service has begun and not ended, in order of creation."""
    created = arrays["created"][: int(arrays.state.created_count)]
    rows = arrays["transfers"][created]
    is_under_way = (rows.started_us >= 0) & (rows.ended_us < 0)
    return transfers_of(created[is_under_way], arrays, state, setup)


def transfers_of(
    numbers: "np.ndarray[tuple[int], np.dtype[np.int64]]",
    arrays: Arrays,
    state: State,
    setup: Setup,
) -> Iterator[Transfer]:
    """Give transfers as they are now."""
    names = ("created_us", "credited_us", "bottleneck", "started_us", "ended_us")
    rows = arrays["transfers"][numbers]
    amounts = zip(rows.remaining_MB.tolist(), rows.rate_MBps.tolist(), strict=True)
    together = zip(numbers.tolist(), amounts, _columns(rows, names), strict=True)
    for number, (remaining_MB, rate_MBps), whole in together:
        created_us, credited_us, bottleneck, started_us, ended_us = whole
        entry = setup.dependencies[number]
        ends = state.tasks[entry.source].node, state.tasks[entry.target].node
        yield Transfer(
            number,
            entry.rank,
            entry,
            setup.routes.route(*ends) or (),
            remaining_MB,
            created_us,
            credited_us,
            rate_MBps,
            bottleneck,
            started_us=_time(started_us),
            ended_us=_time(ended_us),
        )


def _unload_tasks(tasks: Record, state: State) -> None:
    names = ("missing", "status", "ready_us", "started_us", "ended_us")
    for run, values in zip(state.tasks, _columns(tasks, names), strict=True):
        run.missing, status, ready_us, started_us, ended_us = values
        run.status = STATUSES[status]
        run.ready_us, run.started_us = _time(ready_us), _time(started_us)
        run.ended_us = _time(ended_us)


def _unload_links(arrays: Arrays, state: State, setup: Setup) -> None:
    links, hops = arrays["links"], arrays["hops"]
    state.links.factor, state.links.share_MBps = links.factor.tolist(), links.share_MBps.tolist()
    firsts = np.where(links.flows > 0, links.first_hop, NONE).tolist()
    state.links.flows = [
        {number: state.transfers[number] for number in _flows(first, hops)} for first in firsts
    ]
    carried = [each for each in state.transfers.values() if each.is_under_way and each.route]
    carried.sort(key=lambda each: (each.started_us, each.entry.rank))
    state.flows = {each.number: each for each in carried if each.entry.size_MB > 0}
    state.interference = session_of(setup)
    if state.interference is not None:
        active = [link for link, flows in enumerate(state.links.flows) if flows]
        state.interference.update(active, ())


def _flows(at: int, hops: Record) -> Iterator[int]:
    while at != NONE:
        yield int(hops.transfer[at])
        at = hops.behind[at]


def _unload_nodes(arrays: Arrays, state: State, setup: Setup) -> None:
    who, tasks = setup.models.identity("queue_model"), arrays["tasks"]
    state.nodes = []
    for reserved_for, first, waiting in _columns(
        arrays["nodes"], ("task", "first_waiting", "waiting")
    ):
        line = CheckedQueue(setup.models.new_queue(), who)
        task = first
        for _ in range(waiting):
            line.push(waiting_task(state.tasks[task], setup))
            task = int(tasks.behind[task])
        state.nodes.append(NodeState(line, None if reserved_for == NONE else reserved_for))


def _queue(arrays: Arrays, transfers: dict[int, Transfer]) -> EventQueue:
    queue, rows = EventQueue(transfers), arrays["transfers"]
    entries = arrays["queue"][: int(arrays.state.entries)]
    for at_us, order, number in sorted(entries.tolist()):
        kind = order >> KIND_SHIFT
        if kind == TRANSFER_COMPLETE:
            completes_us = int(rows.completes_us[number])
            if completes_us < NEVER_us:
                transfers[number].completes_us = completes_us
                queue.enter(transfers[number])
        elif kind == TRANSFER_START:
            queue.start_at(at_us, transfers[number])
        else:
            queue.push(at_us, kind, number)
    return queue


def _columns(rows: Record, names: Sequence[str]) -> Iterator[tuple[int, ...]]:
    """Give some fields of records, as plain numbers."""
    return zip(*(rows[name].tolist() for name in names), strict=True)


def _time(at_us: int) -> Instant | None:
    return None if at_us < 0 else at_us
