"""Each model against every simple route of small random networks."""

import math
from dataclasses import replace
from itertools import permutations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_core.context import BuildContext
from ncsim_core.network import Link, LinkRates, Network, Node, route_fault
from ncsim_routing.routing_models.minimum_hop import MinimumHopRouting
from ncsim_routing.routing_models.shortest_path import ShortestPathRouting
from ncsim_routing.routing_models.widest_path import WidestPathRouting

MAX_NODES = 6
MAX_LINKS = 14


def bottleneck_cost(route, net):
    return -min((net.bandwidth_MBps[link] for link in route), default=math.inf)


def hop_cost(route, net):
    del net
    return len(route)


def latency_cost(route, net):
    return sum(net.latency_s[link] for link in route)


MODELS = [
    (WidestPathRouting, bottleneck_cost),
    (MinimumHopRouting, hop_cost),
    (ShortestPathRouting, latency_cost),
]


@st.composite
def networks(draw):
    """Draw up to six nodes whose few distinct numbers make ties common."""
    ids = draw(st.permutations([f"n{i}" for i in (0, 1, 2, 10, 11, 20)]))
    ids = ids[: draw(st.integers(1, MAX_NODES))]
    pairs = list(permutations(ids, 2))
    ends = draw(st.lists(st.sampled_from(pairs), max_size=MAX_LINKS)) if pairs else []
    names = draw(st.permutations([f"l{i}" for i in range(len(ends))]))
    links = tuple(
        Link(
            name,
            *pair,
            draw(st.sampled_from([0.0, 1.0, 2.0, 2.5])),
            draw(st.sampled_from([0.0, 0.1, 0.2, 0.3])),
        )
        for name, pair in zip(names, ends, strict=True)
    )
    return rated(Network(tuple(Node(name, 1.0) for name in ids), links))


def rated(net):
    return net.with_rates(
        LinkRates.of([x.bandwidth_MBps for x in net.links], [x.latency_s for x in net.links])
    )


def simple_routes(net, at, target, visited=frozenset(), so_far=()):
    """Yield every usable route that visits no node twice."""
    if at == target:
        yield so_far
        return
    for link in net.outgoing[at]:
        end = net.targets[link]
        if end not in visited | {at} and net.bandwidth_MBps[link] > 0:
            yield from simple_routes(net, end, target, visited | {at}, (*so_far, link))


@pytest.mark.parametrize(("model", "cost"), MODELS)
@settings(max_examples=50, deadline=None)
@given(net=networks())
def test_no_simple_route_is_better(model, cost, net):
    routing = model(BuildContext(net))
    for source in range(len(net.nodes)):
        for target in range(len(net.nodes)):
            route = routing.route(source, target, net)
            every = list(simple_routes(net, source, target))

            if route is None:
                assert not every
            else:
                assert route_fault(route, source, target, net) is None
                assert cost(route, net) == min(cost(other, net) for other in every)


@pytest.mark.parametrize(("model", "cost"), MODELS)
@settings(max_examples=50, deadline=None)
@given(net=networks())
def test_one_search_for_all_targets_answers_as_one_for_each(model, cost, net):
    del cost
    routing = model(BuildContext(net))
    for source in range(len(net.nodes)):
        expected = [routing.route(source, target, net) for target in range(len(net.nodes))]
        found = routing.routes_from(source, net)
        assert list(found) == found[:] == expected
        assert found[-1] == expected[-1]


@pytest.mark.parametrize(("model", "cost"), MODELS)
@settings(max_examples=50, deadline=None)
@given(net=networks(), data=st.data())
def test_the_order_in_which_nodes_and_links_are_listed_changes_nothing(model, cost, net, data):
    del cost
    other = rated(
        replace(
            net,
            nodes=tuple(data.draw(st.permutations(net.nodes))),
            links=tuple(data.draw(st.permutations(net.links))),
        )
    )

    assert routes_by_id(model, net) == routes_by_id(model, other)


def routes_by_id(model, net):
    routing = model(BuildContext(net))
    return {
        (net.nodes[source].id, net.nodes[target].id): route
        and [net.links[link].id for link in route]
        for source in range(len(net.nodes))
        for target, route in enumerate(routing.routes_from(source, net))
    }
