"""Rates by routes: an interference model that decides them is asked about all at once.

Its answer depends on the routes alone, so only what it changes has to be touched.
"""

from ncsim_core.engine.boundary import checked_route_rates
from ncsim_core.engine.moves import Move, Touched
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import State, Transfer
from ncsim_core.network import Route


def use_links(touched: Touched, state: State) -> None:
    """Note which links are in use, for those who ask what links are up against."""
    if state.interference is not None:
        on, off, _ = touched
        state.interference.update(on, off)


def is_followed_by_a_start(state: State, setup: Setup) -> bool:
    """Return whether the next thing to happen is that another transfer starts, at this instant.

    The rates in between would hold for no time. With global reach they are asked for all the same.
    """
    number = state.queue.next_start(state.now_us)
    return number is not None and setup.dependencies[number].size_MB > 0 and not setup.is_global


def moves_by_route(state: State, setup: Setup) -> list[Move]:
    """Return the transfers whose rate or bottleneck moves, by number.

    With global reach, all that are under way.
    """
    if not state.flows:
        return []
    flows = sorted(state.flows.values(), key=_canonical)
    routes = [flow.route for flow in flows]
    answers = checked_route_rates(setup.models, routes, setup.network)
    moves = [
        (flow.number, flow, rate_MBps, bottleneck)
        for flow, (rate_MBps, bottleneck) in zip(flows, answers, strict=True)
        if setup.is_global or rate_MBps != flow.rate_MBps or bottleneck != flow.bottleneck
    ]
    moves.sort()  # numbers differ, so nothing else is compared
    return moves


def _canonical(flow: Transfer) -> tuple[Route, int]:
    return flow.route, flow.number
