"""Rates by links: each is shared equally, and a transfer gets the least share on its route.

A transfer is looked at again only if a share has grown that was its least, or one has shrunk to no
more than its rate: nothing else changes the least share on its route or the first link that has it.
"""

from collections.abc import Iterable

from ncsim_core.engine.moves import Move, Switched
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import State, Transfer
from ncsim_core.network import LinkIndex


def moves_by_link(transfer: Transfer, switched: Switched, state: State, setup: Setup) -> list[Move]:
    """Return the transfers whose rate or bottleneck moves, by number.

    With global reach, all that are under way.

    Args:
        transfer: The one that has started or finished.
        switched: The links that became active or idle by that.
        state: In which it occupies its route, or has released it.
        setup: Of the run.
    """
    links = update_factors(switched, state)
    if setup.is_global:
        update_shares(range(len(state.links.flows)), state, setup)
        affected = dict(state.flows)
    else:
        touched = dict.fromkeys((*transfer.route, *links)) if links else transfer.route
        affected = update_shares(touched, state, setup)
        if transfer.number in state.flows:
            affected[transfer.number] = transfer
    share_of = state.links.share_MBps
    look_up = share_of.__getitem__
    moves = []
    for number, flow in affected.items():
        least = min(flow.route, key=look_up)  # the first link with the least share
        rate_MBps = share_of[least]
        if rate_MBps != flow.rate_MBps or least != flow.bottleneck or setup.is_global:
            moves.append((number, flow, rate_MBps, least))
    moves.sort()  # numbers differ, so nothing else is compared
    return moves


def update_factors(switched: Switched, state: State) -> list[LinkIndex]:
    """Bring interference factors up to date; return the active links whose factor moved."""
    on, off = switched
    session = state.interference
    if session is None or not (on or off):
        return []
    links, factors = session.update(on, off)
    factor_of = state.links.factor
    for link, factor in zip(links, factors, strict=True):
        factor_of[link] = factor
    return list(links)


def update_shares(touched: Iterable[LinkIndex], state: State, setup: Setup) -> dict[int, Transfer]:
    """Bring the shares of active links up to date; return the transfers to look at again.

    Source: Eq. 1 (``eq:fair_share``).
    """
    links, bandwidth_MBps = state.links, setup.bandwidth_MBps
    flows_on, factor_of, share_of = links.flows, links.factor, links.share_MBps
    affected: dict[int, Transfer] = {}
    for link in touched:
        flows = flows_on[link]
        if not flows:
            continue
        share_MBps = bandwidth_MBps[link] * factor_of[link] / len(flows)
        if share_MBps == share_of[link]:
            continue
        share_of[link] = share_MBps
        for number, flow in flows.items():
            if share_MBps <= flow.rate_MBps or flow.bottleneck == link:
                affected[number] = flow  # noqa: PERF403 - a dictionary per link costs more
    return affected
