"""When a transfer starts or finishes: the bandwidth recalculation cascade (Section V-B)."""

from typing import Final

from ncsim_core import units
from ncsim_core.engine.compiled.compiling import Record, inlined
from ncsim_core.engine.compiled.event_queue import complete_at, pause
from ncsim_core.engine.compiled.layout import (
    NONE,
    hop_at,
    link_at,
    move_at,
    switched_at,
    transfer_at,
)
from ncsim_core.engine.compiled.link_shares import moves_by_link
from ncsim_core.engine.compiled.log import log_rates
from ncsim_core.engine.compiled.radio import look_up, switch_links
from ncsim_core.units import MICROSECONDS_PER_SECOND

service_time_us: Final = inlined(units.service_time_us)

START: Final = 1
FINISH: Final = -1


@inlined
def refresh(number: int, change: int, state: Record) -> bool:
    """Apply one start or finish, then bring every affected transfer up to date.

    Returns:
        Whether that is done; if not, a share has to be worked out before ``go_on``.
    """
    state.refreshing = number
    count = occupy(number, state) if change == START else release(number, state)
    state.changed_count = 0
    if state.has_radio and count > 0:
        switch_links(count, change, state)
    return go_on(state)


@inlined
def go_on(state: Record) -> bool:
    """Bring every transfer up to date that the latest start or finish affects."""
    if state.has_radio and not look_up(state):
        return False
    moves_by_link(state.refreshing, state)
    credit_work(state)
    assign_rates(state)
    reschedule_completions(state)
    if state.shows_rates:
        log_rates(state)
    return True


@inlined
def occupy(number: int, state: Record) -> int:
    """Put a transfer on every link of its route; return how many links become active."""
    transfer, count = transfer_at(number, state), 0
    state.flows += 1
    for at in range(transfer.first_hop, transfer.end_hop):
        hop = hop_at(at, state)
        link = link_at(hop.link, state)
        hop.ahead, hop.behind = link.last_hop, NONE
        if link.flows == 0:
            link.factor = 1.0
            link.first_hop = at
            switched_at(count, state).number = hop.link
            count += 1
        else:
            hop_at(link.last_hop, state).behind = at
        link.last_hop = at
        link.flows += 1
    return count


@inlined
def release(number: int, state: Record) -> int:
    """Credit what a transfer still has coming and take it off its links; count the idle ones."""
    transfer, count = transfer_at(number, state), 0
    state.flows -= 1
    for at in range(transfer.first_hop, transfer.end_hop):
        hop = hop_at(at, state)
        link = link_at(hop.link, state)
        if hop.ahead == NONE:
            link.first_hop = hop.behind
        else:
            hop_at(hop.ahead, state).behind = hop.behind
        if hop.behind == NONE:
            link.last_hop = hop.ahead
        else:
            hop_at(hop.behind, state).ahead = hop.ahead
        link.flows -= 1
        if link.flows == 0:
            switched_at(count, state).number = hop.link
            count += 1
    transfer.remaining_MB = 0.0
    transfer.credited_us = state.now_us
    transfer.rate_MBps = 0.0
    return count


@inlined
def credit_work(state: Record) -> None:
    """Credit each transfer what it was served since it was last credited (``eq:progress``)."""
    now_us = state.now_us
    for k in range(state.moves_count):
        flow = transfer_at(move_at(k, state).transfer, state)
        if flow.rate_MBps > 0:
            elapsed_us = now_us - flow.credited_us
            due_MB = flow.rate_MBps * elapsed_us / MICROSECONDS_PER_SECOND
            left_MB = flow.remaining_MB - due_MB
            flow.remaining_MB = left_MB if left_MB > 0 else 0.0
        flow.credited_us = now_us


@inlined
def assign_rates(state: Record) -> None:
    """Give each transfer its new rate, at which every hop must keep up."""
    for k in range(state.moves_count):
        move = move_at(k, state)
        flow = transfer_at(move.transfer, state)
        flow.rate_MBps, flow.bottleneck = move.rate_MBps, move.bottleneck


@inlined
def reschedule_completions(state: Record) -> None:
    """Replace completions: now if nothing is left, none while the rate is zero."""
    now_us = state.now_us
    for k in range(state.moves_count):
        number = move_at(k, state).transfer
        flow = transfer_at(number, state)
        if flow.remaining_MB <= 0:
            complete_at(now_us, number, state)
        elif flow.rate_MBps > 0:
            after_us = service_time_us(flow.remaining_MB, flow.rate_MBps)
            complete_at(now_us + after_us, number, state)
        else:
            pause(number, state)
