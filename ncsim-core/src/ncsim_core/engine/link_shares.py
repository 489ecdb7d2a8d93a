"""Rates by links: each is shared equally, and a transfer gets the least share on its route.

A transfer is looked at again only if a share has grown that was its least, or one has shrunk to no
more than its rate: nothing else changes the least share on its route or the first link that has it.
"""

import math
from collections.abc import Iterable, Sequence

from ncsim_core.contracts.interference_model import InterferenceSession
from ncsim_core.engine.moves import Move, Touched
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import LinkStates, State, Transfer
from ncsim_core.network import LinkIndex


def moves_by_link(transfer: Transfer, touched: Touched, state: State, setup: Setup) -> list[Move]:
    """Return the transfers whose rate or bottleneck moves; with global reach, all under way.

    Args:
        transfer: The one that has started or finished.
        touched: The links of its route.
        state: In which it occupies its route, or has released it.
        setup: Of the run.
    """
    on, off, shared = touched
    links: Iterable[LinkIndex] = shared
    session = state.interference
    if session is not None and (on or off):
        links = dict.fromkeys((*shared, *update_factors(on, off, session, state.links)))
    if setup.is_global:
        return _all_moves(state)
    affected = update_shares(links, state.links)
    if transfer.ended_us is None:
        affected[transfer.number] = transfer
    share_of = state.links.share_MBps
    moves = []
    for number, flow in affected.items():
        rate_MBps, least = math.inf, -1
        for link in flow.route:  # min() with a key takes three times as long
            share_MBps = share_of[link]
            if share_MBps < rate_MBps:  # so that the first of equals stays
                rate_MBps, least = share_MBps, link
        if rate_MBps != flow.rate_MBps or least != flow.bottleneck:
            moves.append((number, flow, rate_MBps, least))
    return moves


def _all_moves(state: State) -> list[Move]:
    """Return the rate of every transfer under way, moved or not."""
    links = state.links
    update_shares([link for link, flows in enumerate(links.flows) if flows], links)
    least = [min(flow.route, key=links.share_MBps.__getitem__) for flow in state.flows.values()]
    return [
        (flow.number, flow, links.share_MBps[link], link)
        for flow, link in zip(state.flows.values(), least, strict=True)
    ]


def update_factors(
    on: Sequence[LinkIndex],
    off: Sequence[LinkIndex],
    session: InterferenceSession,
    links: LinkStates,
) -> list[LinkIndex]:
    """Bring interference factors up to date; return the active links whose factor moved."""
    moved, factors = session.update(on, off)
    for link, factor in zip(moved, factors, strict=True):
        links.factor[link] = factor
    return [link for link in moved if links.flows[link]]


def update_shares(active: Iterable[LinkIndex], links: LinkStates) -> dict[int, Transfer]:
    """Bring the shares of active links up to date; return the transfers to look at again.

    Source: Eq. 1 (``eq:fair_share``).
    """
    bandwidth_MBps, factor_of = links.bandwidth_MBps, links.factor
    flows_on, share_of = links.flows, links.share_MBps
    affected: dict[int, Transfer] = {}
    for link in active:
        flows = flows_on[link]
        earlier_MBps = share_of[link]
        share_of[link] = share_MBps = bandwidth_MBps[link] * factor_of[link] / len(flows)
        if share_MBps < earlier_MBps:
            for number, flow in flows.items():
                if share_MBps <= flow.rate_MBps:
                    affected[number] = flow  # noqa: PERF403 - a dictionary per link costs more
        elif share_MBps > earlier_MBps:
            for number, flow in flows.items():
                if flow.bottleneck == link:
                    affected[number] = flow  # noqa: PERF403
    return affected
