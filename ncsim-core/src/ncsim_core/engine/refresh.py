"""When a transfer starts or finishes: the bandwidth recalculation cascade (Section V-B).

The invariant: all work before the event is credited at the old rate before any replacement
completion is scheduled. Only transfers whose rate really moves are touched, so what a
transfer is credited does not depend on which other links were asked about, and local
refresh equals global refresh to the last bit.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import TypeAlias

from ncsim_core.contracts.interference_model import NO_COMPETITION, Competition
from ncsim_core.engine.link_shares import moves_by_link
from ncsim_core.engine.moves import Move, Switched
from ncsim_core.engine.observer import rate_cause_of, rate_change_of
from ncsim_core.engine.route_rates import moves_by_route
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import State, Transfer
from ncsim_core.network import LinkIndex
from ncsim_core.units import MICROSECONDS_PER_SECOND, service_time_us

Change: TypeAlias = Callable[[State, Transfer], Switched]


def refresh(transfer: Transfer, change: Change, state: State, setup: Setup) -> None:
    """Apply one start or finish, then bring every affected transfer up to date."""
    switched = change(state, transfer)  # 1. occupy or release the route
    if setup.decides_routes:  # 2. whose rate moves, and to what? (Eqs. 1 and 12)
        moves = moves_by_route(switched, state, setup)
    else:
        moves = moves_by_link(transfer, switched, state, setup)
    credit_work(moves, state)  # 3. credit work at the old rates (Eq. 13)
    assign_rates(moves)  # 4. the new rates
    reschedule_completions(moves, state)  # 5. the new finish times
    if moves and state.rate_observers:
        report_rates(transfer, change, moves, state)


def occupy(state: State, transfer: Transfer) -> Switched:
    """Put a transfer on every link of its route; return which links become active."""
    number, flows_on = transfer.number, state.links.flows
    state.flows[number] = transfer
    on = []
    for link in transfer.route:
        flows = flows_on[link]
        if not flows:
            state.links.factor[link] = 1.0
            on.append(link)
        flows[number] = transfer
    return on, ()


def release(state: State, transfer: Transfer) -> Switched:
    """Credit what a transfer still has coming and take it off its links; return the idle ones."""
    number, flows_on = transfer.number, state.links.flows
    del state.flows[number]
    off = []
    for link in transfer.route:
        flows = flows_on[link]
        del flows[number]
        if not flows:
            off.append(link)
    transfer.remaining_MB = 0.0
    transfer.credited_us = state.now_us
    transfer.rate_MBps = 0.0
    return (), off


def credit_work(moves: Iterable[Move], state: State) -> None:
    """Credit each transfer what it was served since it was last credited (``eq:progress``)."""
    now_us = state.now_us
    for _, flow, _, _ in moves:
        if flow.rate_MBps > 0:
            elapsed_us = now_us - flow.credited_us
            due_MB = flow.rate_MBps * elapsed_us / MICROSECONDS_PER_SECOND
            left_MB = flow.remaining_MB - due_MB
            flow.remaining_MB = left_MB if left_MB > 0 else 0.0
        flow.credited_us = now_us


def assign_rates(moves: Iterable[Move]) -> None:
    """Give each transfer its new rate, at which every hop must keep up."""
    for _, flow, rate_MBps, bottleneck in moves:
        flow.rate_MBps, flow.bottleneck = rate_MBps, bottleneck


def reschedule_completions(moves: Iterable[Move], state: State) -> None:
    """Replace completions: now if nothing is left, none while the rate is zero."""
    queue, now_us = state.queue, state.now_us
    for number, flow, rate_MBps, _ in moves:
        if flow.remaining_MB <= 0:
            queue.complete_at(now_us, number, flow.entry.rank)
        elif rate_MBps > 0:
            after_us = service_time_us(flow.remaining_MB, rate_MBps)
            queue.complete_at(now_us + after_us, number, flow.entry.rank)
        else:
            queue.pause(number)


def report_rates(transfer: Transfer, change: Change, moves: Sequence[Move], state: State) -> None:
    """Show the new rates and what explains them to whoever watches."""
    cause = rate_cause_of(("start" if change is occupy else "finish", transfer.number))
    flows_on = state.links.flows
    against = competition_on([bottleneck for _, _, _, bottleneck in moves], state)
    changes = [
        rate_change_of((number, rate_MBps, bottleneck, len(flows_on[bottleneck]), competition))
        for (number, _, rate_MBps, bottleneck), competition in zip(moves, against, strict=True)
    ]
    for observer in state.rate_observers:
        observer.rates_assigned(state.now_us, cause, changes)


def competition_on(links: Sequence[LinkIndex], state: State) -> Sequence[Competition]:
    """Return what each of ``links`` is up against now."""
    if state.interference is None:
        return [NO_COMPETITION] * len(links)
    return state.interference.competition(links)
