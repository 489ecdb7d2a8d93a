"""Rates by links: each is shared equally, and a transfer gets the least share on its route."""

from ncsim_core.compiling import inlined
from ncsim_core.engine.compiled.layout import (
    NONE,
    affected_at,
    changed_at,
    hop_at,
    link_at,
    move_at,
    transfer_at,
)
from ncsim_core.engine.compiled.records import Record


@inlined
def moves_by_link(number: int, state: Record) -> None:
    """Collect the transfers whose rate or bottleneck moves.

    Args:
        number: The transfer that has started or finished.
        state: In which it occupies its route, or has released it.
    """
    state.refreshes += 1
    state.affected_count = state.moves_count = 0
    transfer = transfer_at(number, state)
    for hop in range(transfer.first_hop, transfer.end_hop):
        update_share(hop_at(hop, state).link, state)
    for k in range(state.changed_count):
        update_share(changed_at(k, state).number, state)
    if transfer.ended_us < 0:
        look_at_again(number, state)
    for k in range(state.affected_count):
        look_for_move(affected_at(k, state).number, state)


@inlined
def update_share(link_index: int, state: Record) -> None:
    """Bring the share of an active link up to date; collect the transfers to look at again.

    Source: Eq. 1 (``eq:fair_share``).
    """
    link = link_at(link_index, state)
    if link.flows == 0:
        return
    share_MBps = link.bandwidth_MBps * link.factor / link.flows
    if share_MBps == link.share_MBps:
        return
    link.share_MBps = share_MBps
    at = link.first_hop
    while at != NONE:
        hop = hop_at(at, state)
        flow = transfer_at(hop.transfer, state)
        if share_MBps <= flow.rate_MBps or flow.bottleneck == link_index:
            look_at_again(hop.transfer, state)
        at = hop.behind


@inlined
def look_at_again(number: int, state: Record) -> None:
    """Note, once, that a transfer's rate may move."""
    flow = transfer_at(number, state)
    if flow.looked_at != state.refreshes:
        flow.looked_at = state.refreshes
        affected_at(state.affected_count, state).number = number
        state.affected_count += 1


@inlined
def look_for_move(number: int, state: Record) -> None:
    """Note the new rate of a transfer and the first link with the least share, if either moves."""
    flow = transfer_at(number, state)
    least = hop_at(flow.first_hop, state).link
    rate_MBps = link_at(least, state).share_MBps
    for hop in range(flow.first_hop + 1, flow.end_hop):
        link = hop_at(hop, state).link
        if link_at(link, state).share_MBps < rate_MBps:
            least, rate_MBps = link, link_at(link, state).share_MBps
    if rate_MBps != flow.rate_MBps or least != flow.bottleneck:
        move = move_at(state.moves_count, state)
        move.transfer, move.bottleneck, move.rate_MBps = number, least, rate_MBps
        state.moves_count += 1
