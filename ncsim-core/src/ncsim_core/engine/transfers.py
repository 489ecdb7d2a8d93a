"""Transfers: created when their producer ends, started after latency, completed."""

from ncsim_core.engine.events import TransferComplete, TransferStart
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
    transfer = Transfer(entry, route, entry.size_MB, created_us=state.now_us)
    state.transfers[dependency] = transfer
    starts_us = state.now_us + us_from_s(setup.network.route_latency_s(route))
    state.queue.push(starts_us, TransferStart.priority, TransferStart(transfer), entry.rank)


def start_transfer(transfer: Transfer, state: State, setup: Setup) -> None:
    """Begin byte service; a transfer without bytes completes at once, whatever its rate."""
    transfer.started_us = transfer.credited_us = state.now_us
    for observer in state.observers:
        observer.transfer_started(
            state.now_us, transfer.entry.number, transfer.route, transfer.entry.size_MB
        )
    if transfer.remaining_MB > 0:
        refresh(transfer, occupy, state, setup)
    else:
        event = TransferComplete(transfer)
        state.queue.push(state.now_us, TransferComplete.priority, event, transfer.entry.rank)


def complete_transfer(transfer: Transfer, state: State, setup: Setup) -> None:
    """End byte service and free the route."""
    transfer.ended_us, transfer.completion = state.now_us, None
    for observer in state.observers:
        observer.transfer_ended(state.now_us, transfer.entry.number)
    if transfer.entry.size_MB > 0:
        refresh(transfer, release, state, setup)
