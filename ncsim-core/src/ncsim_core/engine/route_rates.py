"""Rates by routes: an interference model that decides them is asked about all at once.

Its answer depends on the routes alone, so only what it changes has to be touched.
"""

from ncsim_core.engine.boundary import checked_route_rates
from ncsim_core.engine.moves import Move, Touched
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import State, Transfer
from ncsim_core.network import Route


def moves_by_route(touched: Touched, state: State, setup: Setup) -> list[Move]:
    """Return the transfers whose rate or bottleneck moves, by number.

    With global reach, all that are under way.
    """
    if state.interference is not None:
        on, off, _ = touched
        state.interference.update(on, off)
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
