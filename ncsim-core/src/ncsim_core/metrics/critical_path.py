"""The makespan that no contention could make longer: a lower bound of every completed run."""

from ncsim_core.trace.run_trace import RunTrace, RunTransfer
from ncsim_core.units import service_time_us, us_from_s


def critical_path_us(run: RunTrace) -> int:
    """Return when the last task would end with idle nodes and every route to itself.

    The longest path through all DAGs with the run's own placement and routes: injection, compute
    times, latencies, and each transfer at its solo rate. Only for runs in which everything ended.
    """
    ready_us = [run.dags[task.dag].injected_us for task in run.tasks]
    missing = [len(numbers) for numbers in run.incoming]
    outgoing: list[list[RunTransfer]] = [[] for _ in run.tasks]
    for transfer in run.transfers:
        outgoing[transfer.source].append(transfer)
    free = [number for number, count in enumerate(missing) if count == 0]
    last_us = 0
    for number in free:
        end_us = ready_us[number] + _compute_us(number, run)
        last_us = max(last_us, end_us)
        for transfer in outgoing[number]:
            target = transfer.target
            ready_us[target] = max(ready_us[target], end_us + _travel_us(transfer, run))
            missing[target] -= 1
            if missing[target] == 0:
                free.append(target)
    return last_us


def _compute_us(number: int, run: RunTrace) -> int:
    task = run.tasks[number]
    return us_from_s(task.cost / run.nodes[task.node or 0].capacity)


def _travel_us(transfer: RunTransfer, run: RunTrace) -> int:
    """Return latency and service alone; nothing within a node."""
    if transfer.is_local or transfer.started_us is None or transfer.created_us is None:
        return 0
    latency_us = transfer.started_us - transfer.created_us
    return latency_us + service_time_us(transfer.size_MB, run.solo_MBps(transfer))
