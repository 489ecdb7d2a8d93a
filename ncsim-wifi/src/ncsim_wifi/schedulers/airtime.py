"""By how much the neighbourhood of a link will probably slow it, known before anything runs."""

from ncsim_core.contracts.scheduler import NetworkSnapshot
from ncsim_core.network import Network, Route

from ncsim_wifi.conflict import Relations


def usable_routes(snapshot: NetworkSnapshot) -> list[Route]:
    """Return the routes between all ordered pairs of different nodes that have one."""
    nodes = range(len(snapshot.network.nodes))
    pairs = ((source, target) for source in nodes for target in nodes if source != target)
    routes = (snapshot.routes.route(source, target) for source, target in pairs)
    return [route for route in routes if route]


def static_airtimes(routes: list[Route], network: Network) -> list[float]:
    """Return the part of time in which each link sends while one transfer is under way.

    The transfer goes with equal chance between any two nodes, over its route, at the route's
    bottleneck b; a link with bandwidth B then sends during b/B of the time:

        a_k = (1 / number of routes) * sum over routes with k of (bottleneck / B_k)
    """
    airtimes = [0.0] * len(network.links)
    for route in routes:
        bottleneck_MBps = network.route_bottleneck_MBps(route)
        for link in route:
            airtimes[link] += bottleneck_MBps / network.bandwidth_MBps[link] / len(routes)
    return airtimes


def conflict_discounts(airtimes: list[float], related: Relations) -> list[float]:
    """Return the factor 1 / (1 + A) on each link, A being the airtime of its neighbourhood.

    A is the expected number of its contenders that are sending while one other transfer is
    under way somewhere: it shares the channel with itself and A others.
    """
    return [
        1.0 / (1.0 + sum([airtimes[other] for other in related.conflicts(link).tolist()]))
        for link in range(related.link_count)
    ]


def uniform_discounts(discounts: list[float]) -> list[float]:
    """Return the mean discount for every link: as much caution, but blind to where."""
    if not discounts:
        return []
    return [sum(discounts) / len(discounts)] * len(discounts)
