"""The numbers of one run, as they stand in ``metrics.json``.

All times are summed in whole microseconds and divided once, so that the same run gives the same
numbers whether it is read from its trace or was recorded in memory.
"""

import math
from collections.abc import Iterable, Iterator
from typing import Final

from ncsim_core.engine.outcome import RunStatus
from ncsim_core.metrics.critical_path import critical_path_us
from ncsim_core.trace.run_trace import RunTrace, RunTransfer
from ncsim_core.units import MICROSECONDS_PER_SECOND, s_from_us

METRICS_FORMAT: Final = "ncsim-metrics"
METRICS_VERSION: Final = "1.0"


def compute_metrics(run: RunTrace) -> dict[str, object]:
    """Return the metrics of a run, ready for JSON and described by ``metrics_schema``.

    For a run that did not complete, what was still going on counts up to the last event; of
    unfinished transfers, a coarse trace does not tell how much was served.
    """
    end = run.end
    slowdowns = list(_slowdowns(run))
    started = [each for each in run.remote_transfers if each.started_us is not None]
    return {
        "format": METRICS_FORMAT,
        "version": METRICS_VERSION,
        "status": end.status,
        "makespan_s": None if end.makespan_us is None else s_from_us(end.makespan_us),
        "ended_s": s_from_us(end.ended_us),
        "events": end.events,
        "tasks": _counts(task.ended_us is not None for task in run.tasks),
        "transfers": _counts(each.ended_us is not None for each in run.remote_transfers),
        "remote_MB": math.fsum(each.size_MB for each in run.remote_transfers),
        "route_work_MB_hops": math.fsum(each.size_MB * len(each.route) for each in started),
        "critical_path_s": _critical_path_s(run),
        "mean_transfer_slowdown": math.fsum(slowdowns) / len(slowdowns) if slowdowns else None,
        "max_transfer_slowdown": max(slowdowns, default=None),
        "dags": _dag_rows(run),
        "nodes": _node_rows(run),
        "links": _link_rows(run),
    }


def _counts(ended: Iterable[bool]) -> dict[str, int]:
    listed = list(ended)
    return {"total": len(listed), "ended": sum(listed)}


def _critical_path_s(run: RunTrace) -> float | None:
    if run.end.status != RunStatus.COMPLETED:
        return None
    return s_from_us(critical_path_us(run))


def _slowdowns(run: RunTrace) -> Iterator[float]:
    """Yield each served transfer's time of byte service over that on an idle route.

    An idle route takes a microsecond at least, as all times are whole ones; a transfer that took
    none is left out.
    """
    for transfer in run.transfers:
        took_us = (transfer.ended_us or 0) - (transfer.started_us or 0)
        if took_us > 0 and transfer.ended_us is not None and transfer.size_MB > 0:
            alone_us = transfer.size_MB / run.solo_MBps(transfer) * MICROSECONDS_PER_SECOND
            yield took_us / max(1.0, alone_us)


def _dag_rows(run: RunTrace) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for dag in run.dags:
        tasks = run.tasks[dag.first_task : dag.first_task + dag.task_count]
        ends = [task.ended_us for task in tasks if task.ended_us is not None]
        is_whole = len(ends) == len(tasks)
        ended_us = max(ends, default=dag.injected_us)
        rows.append(
            {
                "id": dag.id,
                "injected_s": s_from_us(dag.injected_us),
                "ended_s": s_from_us(ended_us) if is_whole else None,
                "response_s": s_from_us(ended_us - dag.injected_us) if is_whole else None,
            }
        )
    return rows


def _node_rows(run: RunTrace) -> list[dict[str, object]]:
    busy_us, wait_us, ended = ([0] * len(run.nodes) for _ in range(3))
    for task in run.tasks:
        if task.node is None or task.ready_us is None:
            continue
        until_us = run.end.ended_us if task.started_us is None else task.started_us
        wait_us[task.node] += until_us - task.ready_us
        if task.started_us is not None:
            end_us = run.end.ended_us if task.ended_us is None else task.ended_us
            busy_us[task.node] += end_us - task.started_us
            ended[task.node] += task.ended_us is not None
    return [
        {
            "id": node.id,
            "tasks_ended": ended[index],
            "busy_s": s_from_us(busy_us[index]),
            "utilisation": _share(busy_us[index], run),
            "queue_wait_s": s_from_us(wait_us[index]),
        }
        for index, node in enumerate(run.nodes)
    ]


def _share(busy_us: int, run: RunTrace) -> float:
    """Return a part of the time until the run's last event; 0 if no time has passed."""
    return busy_us / run.end.ended_us if run.end.ended_us else 0.0


def _link_rows(run: RunTrace) -> list[dict[str, object]]:
    users: list[list[RunTransfer]] = [[] for _ in run.links]
    for transfer in run.transfers:
        for index in transfer.route:
            users[index].append(transfer)
    rows: list[dict[str, object]] = []
    for link, transfers in zip(run.links, users, strict=True):
        busy_us = _busy_us(transfers, run)
        rows.append(
            {
                "id": link.id,
                "transfers": len(transfers),
                "served_MB": math.fsum(transfer.served_MB for transfer in transfers),
                "busy_s": s_from_us(busy_us),
                "utilisation": _share(busy_us, run),
            }
        )
    return rows


def _busy_us(transfers: Iterable[RunTransfer], run: RunTrace) -> int:
    """Return for how long at least one of the transfers was in service, paused or not."""
    total_us = until_us = 0
    spans = [(each.started_us or 0, _end_us(each, run)) for each in transfers]
    for start_us, end_us in sorted(spans):
        total_us += max(0, end_us - max(start_us, until_us))
        until_us = max(until_us, end_us)
    return total_us


def _end_us(transfer: RunTransfer, run: RunTrace) -> int:
    return run.end.ended_us if transfer.ended_us is None else transfer.ended_us
