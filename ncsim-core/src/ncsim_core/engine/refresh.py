"""When a transfer starts or finishes: the bandwidth recalculation cascade (Section V-B).

The invariant: all work before the event is credited at the old rate before any replacement
completion is scheduled. Only transfers whose rate really moves are touched, so what a
transfer is credited does not depend on which other links were asked about, and local
refresh equals global refresh to the last bit.
"""

from collections.abc import Callable, Collection, Iterable
from typing import NamedTuple, TypeAlias

from ncsim_core.engine.events import TransferComplete
from ncsim_core.engine.observer import RateCause, RateChange
from ncsim_core.engine.setup import Reach, Setup
from ncsim_core.engine.state import State, Transfer
from ncsim_core.network import LinkIndex
from ncsim_core.units import MICROSECONDS_PER_SECOND, service_time_us

UNKNOWN_SHARE_MBps = -1.0
"""Share of a link between getting another flow and being looked at."""


class Switched(NamedTuple):
    """What a start or a finish did to the links of one route.

    Args:
        route: All links whose number of flows changed.
        on: Those that became active.
        off: Those that became idle.
    """

    route: tuple[LinkIndex, ...]
    on: tuple[LinkIndex, ...]
    off: tuple[LinkIndex, ...]


Change: TypeAlias = Callable[[State, Transfer], Switched]


def refresh(transfer: Transfer, change: Change, state: State, setup: Setup) -> None:
    """Apply one start or finish, then bring every affected transfer up to date."""
    switched = change(state, transfer)  # 1. occupy or release the route
    links = update_shares(switched, state, setup)  # 2. whose share moved?
    flows = credited_flows(links, state, setup)  # 3. credit work at the old rates (Eq. 13)
    assign_bottlenecks(flows, state)  # 4. the new rates (Eqs. 1 and 12)
    reschedule_completions(flows, state)  # 5. the new finish times
    if flows and state.rate_observers:
        report_rates(transfer, change, flows, state)


def occupy(state: State, transfer: Transfer) -> Switched:
    """Put a transfer on every link of its route."""
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


def update_shares(switched: Switched, state: State, setup: Setup) -> list[LinkIndex]:
    """Bring factors and shares up to date; return the active links whose share moved.

    The interference model is asked only about what its ``reach`` of the switched links holds.
    With global reach, all active links are looked at and returned.
    """
    is_global = setup.reach is Reach.GLOBAL
    touched = dict.fromkeys(range(len(state.links)) if is_global else switched.route)
    if switched.on or switched.off:
        links, factors = state.interference.update(switched.on, switched.off)
        for index, factor in zip(links, factors, strict=True):
            state.links[index].factor = factor
            touched[index] = None
    bandwidth_MBps = setup.network.bandwidth_MBps
    moved = []
    for index in touched:
        link = state.links[index]
        if not link.flows:
            continue
        share_MBps = bandwidth_MBps[index] * link.factor / len(link.flows)
        if share_MBps != link.share_MBps or is_global:
            link.share_MBps = share_MBps
            moved.append(index)
    return moved


def credited_flows(links: Collection[LinkIndex], state: State, setup: Setup) -> list[Transfer]:
    """Return the transfers on ``links`` whose rate moves, credited up to now at the old rate.

    With global reach, all of them.
    """
    affected: dict[int, Transfer] = {}
    for index in links:
        affected.update(state.links[index].flows)
    flows = [affected[number] for number in sorted(affected)]
    if setup.reach is Reach.LOCAL:
        flows = [flow for flow in flows if _rate_moves(flow, state)]
    for flow in flows:
        credit(flow, state)
    return flows


def _rate_moves(flow: Transfer, state: State) -> bool:
    return bottleneck_of(flow, state) != (flow.rate_MBps, flow.bottleneck)


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


def bottleneck_of(flow: Transfer, state: State) -> tuple[float, LinkIndex]:
    """Return the least share on a route in MB/s and the first link that has it."""
    links = state.links
    least = flow.route[0]
    least_MBps = links[least].share_MBps
    for index in flow.route:
        share_MBps = links[index].share_MBps
        if share_MBps < least_MBps:
            least, least_MBps = index, share_MBps
    return least_MBps, least


def assign_bottlenecks(flows: Iterable[Transfer], state: State) -> None:
    """Give each transfer the least share on its route, where every hop must keep up."""
    for flow in flows:
        flow.rate_MBps, flow.bottleneck = bottleneck_of(flow, state)


def reschedule_completions(flows: Iterable[Transfer], state: State) -> None:
    """Replace completions: now if nothing is left, none while the rate is zero."""
    for flow in flows:
        if flow.completion is not None:
            state.queue.cancel(flow.completion)
            flow.completion = None
        if flow.remaining_MB <= 0:
            after_us = 0
        elif flow.rate_MBps > 0:
            after_us = service_time_us(flow.remaining_MB, flow.rate_MBps)
        else:
            continue
        flow.completion = state.queue.push(
            state.now_us + after_us,
            TransferComplete.priority,
            TransferComplete(flow),
            flow.entry.rank,
        )


def report_rates(
    transfer: Transfer, change: Change, flows: Collection[Transfer], state: State
) -> None:
    """Show the new rates and what explains them to whoever watches."""
    cause = RateCause("start" if change is occupy else "finish", transfer.entry.number)
    competition = state.interference.competition([flow.bottleneck for flow in flows])
    changes = [
        RateChange(
            flow.entry.number,
            flow.rate_MBps,
            flow.bottleneck,
            len(state.links[flow.bottleneck].flows),
            against,
        )
        for flow, against in zip(flows, competition, strict=True)
    ]
    for observer in state.rate_observers:
        observer.rates_assigned(state.now_us, cause, changes)
