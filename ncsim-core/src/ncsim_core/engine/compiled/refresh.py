"""When a transfer starts or finishes: the bandwidth recalculation cascade (Section V-B)."""

from typing import Final

from ncsim_core import units
from ncsim_core.compiling import inlined
from ncsim_core.engine.compiled.event_queue import complete_at
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
from ncsim_core.engine.compiled.records import Record
from ncsim_core.units import MICROSECONDS_PER_SECOND, NEVER_us

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
    bring_up_to_date(state)  # 3. to 5.
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
def bring_up_to_date(state: Record) -> None:
    """Give each transfer its new rate: steps 3 to 5, which concern it alone."""
    now_us = state.now_us
    for k in range(state.moves_count):
        move = move_at(k, state)
        flow = transfer_at(move.transfer, state)
        left_MB = flow.remaining_MB
        if flow.rate_MBps > 0:  # 3. credit work at the old rate (``eq:progress``)
            elapsed_us = now_us - flow.credited_us
            left_MB -= flow.rate_MBps * elapsed_us / MICROSECONDS_PER_SECOND
            left_MB = left_MB if left_MB > 0 else 0.0
            flow.remaining_MB = left_MB
        flow.credited_us = now_us
        flow.rate_MBps, flow.bottleneck = move.rate_MBps, move.bottleneck  # 4.
        if left_MB <= 0:  # 5. replace the completion
            completes_us = now_us
        elif move.rate_MBps > 0:
            completes_us = now_us + service_time_us(left_MB, move.rate_MBps)
        else:
            completes_us = NEVER_us
        complete_at(completes_us, move.transfer, state)
