"""Properties of routing models."""

from collections.abc import Iterator
from dataclasses import replace
from typing import cast

from hypothesis.strategies import SearchStrategy
from typing_extensions import override

from ncsim_core.contracts.routing_model import RoutingModel
from ncsim_core.network import LinkId, Network, NodeIndex, Route, route_fault
from ncsim_core.testing import strategies
from ncsim_core.testing.checking import check
from ncsim_core.testing.oracle import all_routes, best_value, route_value
from ncsim_core.testing.questions import Case, reversed_links
from ncsim_core.testing.subject import Subject
from ncsim_core.testing.suites.base import ComponentSuite


class RoutingModelSuite(ComponentSuite):
    """Checks of a routing model."""

    kind = "routing_model"

    @override
    def cases(self) -> SearchStrategy[Case]:
        return strategies.questions_about(strategies.networks(max_nodes=5, max_links=10))

    @check()
    def check_routes_are_chains(self, subject: Subject, case: Case) -> None:
        """A route is a chain of usable links from source to target, no node twice."""
        for source, target, route in _routes(subject, case):
            fault = None if route is None else route_fault(route, source, target, case.network)
            assert fault is None, f"{_ends(case.network, source, target)}: {fault}"

    @check()
    def check_route_to_itself_is_empty(self, subject: Subject, case: Case) -> None:
        """Data that stays on its node takes no link."""
        for source, target, route in _routes(subject, case):
            assert source != target or route == (), f"node {source} to itself: {route!r}"

    @check()
    def check_there_is_a_route_if_there_can_be(self, subject: Subject, case: Case) -> None:
        """No route is given only where there is none; ``single_hop``: no single link."""
        limit = 1 if subject.capability("single_hop") is not None else len(case.network.nodes)
        for source, target, route in _routes(subject, case):
            possible = (r for r in all_routes(source, target, case.network) if len(r) <= limit)
            if route is None:
                way = next(possible, None)
                assert way is None, f"{_ends(case.network, source, target)}: links {way} lead there"

    @check()
    def check_listing_order_changes_nothing(self, subject: Subject, case: Case) -> None:
        """Listing the links in another order gives the same routes: ties break on ids."""
        turned = case.with_network(reversed_links(case.network))
        here, there = _routes_by_id(subject, case), _routes_by_id(subject, turned)
        assert here == there

    @check()
    def check_routes_from_equals_route(self, subject: Subject, case: Case) -> None:
        """``routes_from`` answers as ``route`` does, one target at a time."""
        model = cast("RoutingModel", subject.build(case))
        nodes = range(len(case.network.nodes))
        for source in nodes:
            row = list(model.routes_from(source, case.network))
            assert row == [model.route(source, target, case.network) for target in nodes]

    @check(capability="pure")
    def check_pure_routes_follow_from_the_network(self, subject: Subject, case: Case) -> None:
        """Seed and config sections change no route, so that runs may share them."""
        bare = replace(subject, sections={})
        one = cast("RoutingModel", subject.build(case, seed=1))
        other = cast("RoutingModel", bare.build(case, seed=2))
        nodes = range(len(case.network.nodes))
        for source in nodes:
            for target in nodes:
                routes = [model.route(source, target, case.network) for model in (one, other)]
                assert routes[0] == routes[1], _ends(case.network, source, target)

    @check(capability="objective")
    def check_routes_are_optimal(self, subject: Subject, case: Case) -> None:
        """No loop-free route is better by the declared objective."""
        objective = subject.capability("objective")
        assert objective in ("hops", "latency", "bottleneck"), f"unknown objective {objective!r}"
        for source, target, route in _routes(subject, case):
            if route is not None:
                best = best_value(objective, source, target, case.network)
                value = route_value(objective, route, case.network)
                assert value == best, f"{_ends(case.network, source, target)}: {value}, not {best}"


def _routes(subject: Subject, case: Case) -> Iterator[tuple[NodeIndex, NodeIndex, Route | None]]:
    """Yield source, target and route of all pairs."""
    model = cast("RoutingModel", subject.build(case))
    nodes = range(len(case.network.nodes))
    for source in nodes:
        for target in nodes:
            yield source, target, model.route(source, target, case.network)


def _routes_by_id(subject: Subject, case: Case) -> list[tuple[LinkId, ...] | None]:
    return [
        None if route is None else tuple(case.network.links[link].id for link in route)
        for _, _, route in _routes(subject, case)
    ]


def _ends(network: Network, source: NodeIndex, target: NodeIndex) -> str:
    return f"{network.nodes[source].id} to {network.nodes[target].id}"
