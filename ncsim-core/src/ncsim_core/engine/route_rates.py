"""Rates by routes: an interference model that decides them is asked about all at once.

Its answer depends on the routes alone, so only what it changes has to be touched.
"""

from ncsim_core.engine.boundary import checked_route_rates
from ncsim_core.engine.moves import Move, Switched
from ncsim_core.engine.setup import Reach, Setup
from ncsim_core.engine.state import State, Transfer
from ncsim_core.network import Route


def moves_by_route(switched: Switched, state: State, setup: Setup) -> list[Move]:
    """Return the transfers whose rate or bottleneck moves, by number.

    With global reach, all that are under way.
    """
    state.interference.update(switched.on, switched.off)
    if not state.flows:
        return []
    flows = sorted(state.flows.values(), key=_canonical)
    routes = [flow.route for flow in flows]
    answers = checked_route_rates(setup.models, routes, setup.network)
    moves = [
        Move(flow, rate_MBps, bottleneck)
        for flow, (rate_MBps, bottleneck) in zip(flows, answers, strict=True)
        if setup.reach is Reach.GLOBAL
        or rate_MBps != flow.rate_MBps
        or bottleneck != flow.bottleneck
    ]
    return sorted(moves, key=lambda move: move.flow.entry.number)


def _canonical(flow: Transfer) -> tuple[Route, int]:
    return flow.route, flow.entry.number
