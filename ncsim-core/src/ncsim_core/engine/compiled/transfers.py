"""Transfers: created when their producer ends, started after latency, completed."""

from ncsim_core.compiling import inlined
from ncsim_core.engine.compiled.event_queue import complete_at, push, push_transfer
from ncsim_core.engine.compiled.layout import created_at, task_at, transfer_at
from ncsim_core.engine.compiled.records import Record
from ncsim_core.engine.compiled.refresh import FINISH, START, go_on, refresh
from ncsim_core.engine.events import TASK_READY, TRANSFER_START


@inlined
def create_transfer(number: int, state: Record) -> None:
    """Pay the latency of a dependency; the route stays idle meanwhile."""
    transfer = transfer_at(number, state)
    created_at(state.created_count, state).number = number
    state.created_count += 1
    transfer.remaining_MB = transfer.size_MB
    transfer.created_us = state.now_us
    push_transfer(state.now_us + transfer.latency_us, TRANSFER_START, number, state)


@inlined
def start_transfer(number: int, state: Record) -> bool:
    """Begin byte service; a transfer without bytes completes at once, whatever its rate.

    Returns:
        Whether that is done; if not, a share has to be worked out before ``resume``.
    """
    now_us, transfer = state.now_us, transfer_at(number, state)
    transfer.started_us = transfer.credited_us = now_us
    if transfer.remaining_MB > 0:
        return refresh(number, START, state)
    complete_at(now_us, number, state)
    return True


@inlined
def complete_transfer(number: int, state: Record) -> bool:
    """End byte service, free the route and tell the waiting task; answer as above."""
    transfer = transfer_at(number, state)
    transfer.ended_us = state.now_us
    if transfer.size_MB > 0 and not refresh(number, FINISH, state):
        return False
    deliver_input(transfer.target, state)
    return True


@inlined
def resume(state: Record) -> bool:
    """Do what is left of a start or an end that stopped for a share; answer as above."""
    if not go_on(state):
        return False
    transfer = transfer_at(state.refreshing, state)
    if transfer.ended_us >= 0:
        deliver_input(transfer.target, state)
    return True


@inlined
def deliver_input(task: int, state: Record) -> None:
    """Count one input of a task as arrived; with the last one it becomes ready."""
    run = task_at(task, state)
    run.missing -= 1
    if run.missing == 0:
        push(state.now_us, TASK_READY, task, state)
