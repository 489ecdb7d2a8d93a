"""Transfers: created when their producer ends, started after latency, completed."""

from ncsim_core.engine.events import TASK_READY
from ncsim_core.engine.refresh import occupy, refresh, release
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import State, Transfer
from ncsim_core.errors import EngineError
from ncsim_core.network import NodeIndex
from ncsim_core.units import us_from_s


def create_transfer(
    dependency: int, source: NodeIndex, target: NodeIndex, state: State, setup: Setup
) -> None:
    """Choose the route of a dependency and pay its latency; the route stays idle meanwhile."""
    entry = setup.dependencies[dependency]
    route = setup.routes.route(source, target)
    if route is None:
        raise EngineError(f"dependency {dependency} was found routable at injection, now it is not")
    now_us = state.now_us
    transfer = Transfer(dependency, entry.rank, entry, route, entry.size_MB, now_us)
    state.transfers[dependency] = transfer
    if setup.is_without_latency:
        state.queue.start_soon(now_us, transfer)
    else:
        after_us = us_from_s(setup.network.route_latency_s(route))
        state.queue.start_at(now_us + after_us, transfer)


def start_transfer(number: int, state: State, setup: Setup) -> None:
    """Begin byte service; a transfer without bytes completes at once, whatever its rate."""
    transfer = state.transfers[number]
    transfer.started_us = transfer.credited_us = state.now_us
    for observer in state.observers:
        observer.transfer_started(state.now_us, number, transfer.route, transfer.entry.size_MB)
    if transfer.remaining_MB > 0:
        refresh(transfer, occupy, state, setup)
    else:
        transfer.completes_us = state.now_us
        state.queue.enter(transfer)


def complete_transfer(number: int, state: State, setup: Setup) -> None:
    """End byte service, free the route and tell the waiting task."""
    transfer = state.transfers[number]
    transfer.ended_us = state.now_us
    for observer in state.observers:
        observer.transfer_ended(state.now_us, number)
    if transfer.entry.size_MB > 0:
        refresh(transfer, release, state, setup)
    deliver_input(transfer.entry.target, state)


def deliver_input(task: int, state: State) -> None:
    """Count one input of a task as arrived; with the last one it becomes ready."""
    run = state.tasks[task]
    run.missing -= 1
    if run.missing == 0:
        state.queue.push_soon(state.now_us, TASK_READY, task)
