"""Rates by links: each is shared equally, and a transfer gets the least share on its route."""

from ncsim_core.engine.moves import Move, Switched
from ncsim_core.engine.setup import Reach, Setup
from ncsim_core.engine.state import State, Transfer
from ncsim_core.network import LinkIndex

UNKNOWN_SHARE_MBps = -1.0
"""Share of a link between getting another flow and being looked at."""


def moves_by_link(switched: Switched, state: State, setup: Setup) -> list[Move]:
    """Return the transfers whose rate or bottleneck moves, by number.

    With global reach, all that are under way.
    """
    affected: dict[int, Transfer] = {}
    for index in update_shares(switched, state, setup):
        affected.update(state.links[index].flows)
    moves = [bottleneck_of(affected[number], state) for number in sorted(affected)]
    if setup.reach is Reach.GLOBAL:
        return moves
    return [
        move
        for move in moves
        if move.rate_MBps != move.flow.rate_MBps or move.bottleneck != move.flow.bottleneck
    ]


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


def bottleneck_of(flow: Transfer, state: State) -> Move:
    """Return the least share on a route and the first link that has it."""
    links = state.links
    least = flow.route[0]
    least_MBps = links[least].share_MBps
    for index in flow.route:
        share_MBps = links[index].share_MBps
        if share_MBps < least_MBps:
            least, least_MBps = index, share_MBps
    return Move(flow, least_MBps, least)
