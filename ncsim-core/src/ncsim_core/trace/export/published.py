"""The trace form of the published ncsim (anrg-ncsim), for scripts that read it.

Eight kinds of event, times in seconds, no rates. As there, a transfer begins when its producer
ends, so that its duration includes latency, ``link_id`` is the first link of the route, and
``route`` is given when there are several. Unlike there, a run that did not complete has a makespan
of null.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path

from ncsim_core.trace.encoding import to_json
from ncsim_core.trace.loading import load_run
from ncsim_core.trace.reader import read_trace
from ncsim_core.trace.records import (
    Done,
    Ended,
    Injected,
    Started,
    TraceRecord,
    TransferEnded,
    TransferStarted,
)
from ncsim_core.trace.run_trace import RunTrace, RunTransfer
from ncsim_core.units import s_from_us

PUBLISHED_VERSION = "1.0"


def published_text(path: Path | str) -> str:
    """Return a trace in the published form, one JSON object per line."""
    return "".join(f"{to_json(event)}\n" for event in published_events(path))


def published_events(path: Path | str) -> Iterator[dict[str, object]]:
    """Yield the events of the published form in order.

    Raises:
        TraceError: ``path`` is no trace.
    """
    run = load_run(path)
    sequence = 0
    with read_trace(path) as reader:
        for event in _events(run, iter(reader)):
            if event["type"] == "sim_end":
                event["total_events"] = sequence
            yield {**event, "seq": sequence}
            sequence += 1


def _events(run: RunTrace, records: Iterator[TraceRecord]) -> Iterator[dict[str, object]]:
    yield _event(
        0,
        "sim_start",
        trace_version=PUBLISHED_VERSION,
        seed=run.header.seed,
        scenario=run.header.scenario,
        scenario_hash=run.header.scenario_sha256,
    )
    delayed = _delayed_by_producer(run)
    for record in records:
        match record:
            case Injected(at_us=at_us, dag_id=dag_id, tasks=tasks):
                names = [task_id for task_id, _ in tasks]
                yield _event(at_us, "dag_inject", dag_id=dag_id, task_ids=names)
            case Started():
                yield _event(record.at_us, "task_scheduled", **_task(record, run))
                yield _event(record.at_us, "task_start", **_task(record, run))
            case Ended():
                yield _task_complete(record, run)
                for transfer in delayed.get(record.task, ()):
                    yield _transfer_start(transfer, run)
            case TransferStarted() | TransferEnded():
                yield from _transfer_events(record, run)
            case Done():
                yield _sim_end(record)
            case _:
                pass  # the published form does not tell placement, readiness and rates


def _event(at_us: int, kind: str, **fields: object) -> dict[str, object]:
    return {"sim_time": s_from_us(at_us), "type": kind, **fields}


def _task(record: Started | Ended, run: RunTrace) -> dict[str, object]:
    task = run.tasks[record.task]
    return {
        "dag_id": run.dags[task.dag].id,
        "task_id": task.id,
        "node_id": run.nodes[record.node].id,
    }


def _task_complete(record: Ended, run: RunTrace) -> dict[str, object]:
    started_us = run.tasks[record.task].started_us
    ran_us = record.at_us - (record.at_us if started_us is None else started_us)
    return _event(record.at_us, "task_complete", **_task(record, run), duration=s_from_us(ran_us))


def _delayed_by_producer(run: RunTrace) -> Mapping[int, list[RunTransfer]]:
    """Return by task the transfers that pay latency before their bytes are served."""
    delayed: dict[int, list[RunTransfer]] = {}
    for transfer in run.transfers:
        if transfer.route and transfer.started_us != transfer.created_us:
            delayed.setdefault(transfer.source, []).append(transfer)
    return delayed


def _transfer_events(
    record: TransferStarted | TransferEnded, run: RunTrace
) -> Iterator[dict[str, object]]:
    transfer = run.transfers[record.transfer]
    if isinstance(record, TransferEnded):
        created_us = record.at_us if transfer.created_us is None else transfer.created_us
        took_s = s_from_us(record.at_us - created_us)
        ends = _ends(transfer, run)
        route = _route(transfer, run)
        yield _event(record.at_us, "transfer_complete", **ends, duration=took_s, **route)
    elif transfer.created_us == transfer.started_us:
        yield _transfer_start(transfer, run)


def _transfer_start(transfer: RunTransfer, run: RunTrace) -> dict[str, object]:
    return _event(
        transfer.created_us or 0,
        "transfer_start",
        **_ends(transfer, run),
        data_size=transfer.size_MB,
        **_route(transfer, run),
    )


def _ends(transfer: RunTransfer, run: RunTrace) -> dict[str, object]:
    return {
        "dag_id": run.dags[transfer.dag].id,
        "from_task": run.tasks[transfer.source].id,
        "to_task": run.tasks[transfer.target].id,
        "link_id": run.links[transfer.route[0]].id,
    }


def _route(transfer: RunTransfer, run: RunTrace) -> dict[str, object]:
    links = [run.links[link].id for link in transfer.route]
    return {"route": links} if len(links) > 1 else {}


def _sim_end(record: Done) -> dict[str, object]:
    makespan_s = None if record.makespan_us is None else s_from_us(record.makespan_us)
    return _event(record.at_us, "sim_end", status=record.status, makespan=makespan_s)
