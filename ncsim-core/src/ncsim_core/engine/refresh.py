"""When a transfer starts or finishes: the bandwidth recalculation cascade (Section V-B).

The invariant: all work before the event is credited at the old rate before any replacement
completion is scheduled. Only transfers whose rate really moves are touched, so what a
transfer is credited does not depend on which other links were asked about, and local
refresh equals global refresh to the last bit.
"""

from collections.abc import Callable, Iterable
from typing import TypeAlias

from ncsim_core.engine.events import TransferComplete
from ncsim_core.engine.link_shares import UNKNOWN_SHARE_MBps, moves_by_link
from ncsim_core.engine.moves import Move, Switched
from ncsim_core.engine.observer import RateCause, RateChange
from ncsim_core.engine.route_rates import moves_by_route
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import State, Transfer
from ncsim_core.units import MICROSECONDS_PER_SECOND, service_time_us

Change: TypeAlias = Callable[[State, Transfer], Switched]


def refresh(transfer: Transfer, change: Change, state: State, setup: Setup) -> None:
    """Apply one start or finish, then bring every affected transfer up to date."""
    switched = change(state, transfer)  # 1. occupy or release the route
    moves = rate_moves(switched, state, setup)  # 2. whose rate moves, and to what?
    credit_work(moves, state)  # 3. credit work at the old rates (Eq. 13)
    assign_rates(moves)  # 4. the new rates (Eqs. 1 and 12)
    reschedule_completions(moves, state)  # 5. the new finish times
    if moves and state.rate_observers:
        report_rates(transfer, change, moves, state)


def occupy(state: State, transfer: Transfer) -> Switched:
    """Put a transfer on every link of its route."""
    state.flows[transfer.entry.number] = transfer
    on = []
    for index in transfer.route:
        link = state.links[index]
        link.share_MBps = UNKNOWN_SHARE_MBps
        if not link.flows:
            link.factor = 1.0
            on.append(index)
        link.flows[transfer.entry.number] = transfer
    return Switched(transfer.route, tuple(on), ())


def release(state: State, transfer: Transfer) -> Switched:
    """Credit what a transfer still has coming and take it off every link of its route."""
    del state.flows[transfer.entry.number]
    off = []
    for index in transfer.route:
        link = state.links[index]
        link.served_MB += transfer.remaining_MB
        del link.flows[transfer.entry.number]
        if not link.flows:
            off.append(index)
    transfer.remaining_MB = 0.0
    transfer.credited_us = state.now_us
    transfer.rate_MBps = 0.0
    return Switched(transfer.route, (), tuple(off))


def rate_moves(switched: Switched, state: State, setup: Setup) -> list[Move]:
    """Return the transfers whose rate or bottleneck moves, by number.

    With global reach, all that are under way.
    """
    if setup.models.interference.decides_routes:
        return moves_by_route(switched, state, setup)
    return moves_by_link(switched, state, setup)


def credit_work(moves: Iterable[Move], state: State) -> None:
    """Credit each transfer up to now at its old rate."""
    for flow, _, _ in moves:
        credit(flow, state)


def credit(flow: Transfer, state: State) -> None:
    """Count what a transfer was served since it was last credited (Eq. 13, ``eq:progress``)."""
    elapsed_us = state.now_us - flow.credited_us
    if elapsed_us > 0 and flow.rate_MBps > 0:
        due_MB = flow.rate_MBps * elapsed_us / MICROSECONDS_PER_SECOND
        served_MB = min(flow.remaining_MB, due_MB)
        flow.remaining_MB -= served_MB
        for index in flow.route:
            state.links[index].served_MB += served_MB
    flow.credited_us = state.now_us


def assign_rates(moves: Iterable[Move]) -> None:
    """Give each transfer its new rate, at which every hop must keep up."""
    for flow, rate_MBps, bottleneck in moves:
        flow.rate_MBps, flow.bottleneck = rate_MBps, bottleneck


def reschedule_completions(moves: Iterable[Move], state: State) -> None:
    """Replace completions: now if nothing is left, none while the rate is zero."""
    for flow, rate_MBps, _ in moves:
        if flow.completion is not None:
            state.queue.cancel(flow.completion)
            flow.completion = None
        if flow.remaining_MB <= 0:
            after_us = 0
        elif rate_MBps > 0:
            after_us = service_time_us(flow.remaining_MB, rate_MBps)
        else:
            continue
        flow.completion = state.queue.push(
            state.now_us + after_us,
            TransferComplete.priority,
            TransferComplete(flow),
            flow.entry.rank,
        )


def report_rates(transfer: Transfer, change: Change, moves: list[Move], state: State) -> None:
    """Show the new rates and what explains them to whoever watches."""
    cause = RateCause("start" if change is occupy else "finish", transfer.entry.number)
    competition = state.interference.competition([move.bottleneck for move in moves])
    changes = [
        RateChange(
            flow.entry.number,
            rate_MBps,
            bottleneck,
            len(state.links[bottleneck].flows),
            against,
        )
        for (flow, rate_MBps, bottleneck), against in zip(moves, competition, strict=True)
    ]
    for observer in state.rate_observers:
        observer.rates_assigned(state.now_us, cause, changes)
