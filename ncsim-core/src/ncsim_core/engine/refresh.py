"""When a transfer starts or finishes: the bandwidth recalculation cascade (Section V-B).

The invariant: all work before the event is credited at the old rate before any replacement
completion is scheduled. Only transfers whose rate really moves are touched, so what a
transfer is credited does not depend on which other links were asked about, and local
refresh equals global refresh to the last bit.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import TypeAlias

from ncsim_core.engine.link_shares import moves_by_link
from ncsim_core.engine.moves import Move, Touched
from ncsim_core.engine.observer import RateCause, RateColumns, changes_of
from ncsim_core.engine.route_rates import is_followed_by_a_start, moves_by_route, use_links
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import State, Transfer
from ncsim_core.units import MICROSECONDS_PER_SECOND, NEVER_us, service_time_us

Change: TypeAlias = Callable[[State, Transfer], Touched]


def refresh(transfer: Transfer, change: Change, state: State, setup: Setup) -> None:
    """Apply one start or finish, then bring every affected transfer up to date."""
    touched = change(state, transfer)  # 1. occupy or release the route
    if setup.decides_routes:  # 2. whose rate moves, and to what? (Eqs. 1 and 12)
        use_links(touched, state)
        if change is occupy and is_followed_by_a_start(state, setup):
            return  # which asks for both
        moves = moves_by_route(state, setup)
    else:
        moves = moves_by_link(transfer, touched, state, setup)
    bring_up_to_date(moves, state)  # 3. to 5.
    if moves and state.shows_rates:
        report_rates(transfer, change, moves, state)


def occupy(state: State, transfer: Transfer) -> Touched:
    """Put a transfer on every link of its route, alone or with others."""
    number, links = transfer.number, state.links
    flows_on = links.flows
    state.flows[number] = transfer
    on, shared = [], []
    for link in transfer.route:
        flows = flows_on[link]
        if flows:
            shared.append(link)
        else:
            on.append(link)
            links.factor[link] = 1.0
            links.share_MBps[link] = links.bandwidth_MBps[link]
        flows[number] = transfer
    return on, (), shared


def release(state: State, transfer: Transfer) -> Touched:
    """Credit what a transfer still has coming and take it off its links."""
    number, flows_on = transfer.number, state.links.flows
    del state.flows[number]
    off, shared = [], []
    for link in transfer.route:
        flows = flows_on[link]
        del flows[number]
        if flows:
            shared.append(link)
        else:
            off.append(link)
    transfer.remaining_MB = 0.0
    transfer.credited_us = state.now_us
    transfer.rate_MBps = 0.0
    return (), off, shared


def bring_up_to_date(moves: Iterable[Move], state: State) -> None:
    """Give each transfer its new rate: steps 3 to 5, which concern it alone (``eq:progress``)."""
    now_us, enter = state.now_us, state.queue.enter
    for _, flow, rate_MBps, bottleneck in moves:
        left_MB = flow.remaining_MB
        if flow.rate_MBps > 0:  # 3. credit work at the old rate
            elapsed_us = now_us - flow.credited_us
            left_MB -= flow.rate_MBps * elapsed_us / MICROSECONDS_PER_SECOND
            flow.remaining_MB = left_MB = left_MB if left_MB > 0 else 0.0
        flow.credited_us = now_us
        flow.rate_MBps, flow.bottleneck = rate_MBps, bottleneck  # 4. every hop must keep up
        if left_MB <= 0:  # 5. replace the completion
            completes_us = now_us
        elif rate_MBps > 0:
            completes_us = now_us + service_time_us(left_MB, rate_MBps)
        else:
            completes_us = NEVER_us
        flow.completes_us = completes_us
        if completes_us < flow.entered_us:
            enter(flow)


def report_rates(transfer: Transfer, change: Change, moves: list[Move], state: State) -> None:
    """Show the new rates and what explains them to whoever watches."""
    columns = columns_of(moves, state)
    log = state.log
    if log is not None:
        log.rates[len(log.events) - 1] = columns
    if state.observers:
        cause = RateCause("start" if change is occupy else "finish", transfer.number)
        for observer in state.observers:
            if observer.wants_rates:
                observer.rates_assigned(state.now_us, cause, changes_of(columns))


def columns_of(moves: list[Move], state: State) -> RateColumns:
    """Return the new rates and what explains them, transfers in order."""
    flows_on, session = state.links.flows, state.interference
    counts: Sequence[int]
    if len(moves) == 1:  # as nearly half of them, at a third of the time
        ((number, _, rate_MBps, link),) = moves
        numbers, rates_MBps, links, counts = (
            (number,),
            (rate_MBps,),
            (link,),
            (len(flows_on[link]),),
        )
    else:
        moves.sort()  # by number, which differ
        numbers, _, rates_MBps, links = zip(*moves)  # noqa: B905 - a keyword takes a fifth longer
        counts = [len(flows_on[link]) for link in links]
    against = None if session is None else session.against(links)
    return numbers, rates_MBps, links, counts, against
