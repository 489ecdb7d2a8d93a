"""The rules for ties, which pin published results (SPEC 9 and 10)."""

import math
import random

import pytest
from ncsim_core.context import BuildContext
from ncsim_core.network import Link, LinkRates, Network, Node
from ncsim_routing.routing_models.minimum_hop import MinimumHopRouting
from ncsim_routing.routing_models.shortest_path import ShortestPathRouting
from ncsim_routing.routing_models.widest_path import WidestPathRouting
from ncsim_routing.search import breadth_first, route_to

ALL_MODELS = [WidestPathRouting, MinimumHopRouting, ShortestPathRouting]


def network(*hops, nodes=("a", "b", "c", "d"), seed=None):
    """Build a network of hops ``(link id, source, target, bandwidth_MBps, latency_s)``."""
    links = [Link(link_id, source, target, *numbers) for link_id, source, target, *numbers in hops]
    if seed is not None:
        random.Random(seed).shuffle(links)
    rates = LinkRates.of([link.bandwidth_MBps for link in links], [x.latency_s for x in links])
    return Network(tuple(Node(name, 1.0) for name in nodes), tuple(links), rates)


def way(model, net, source, target):
    """Return the ids of the links from source to target."""
    index = net.node_index
    route = model(BuildContext(net)).route(index[source], index[target], net)
    return None if route is None else [net.links[link].id for link in route]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("model", ALL_MODELS)
class TestTiesForEveryModel:
    def test_the_lowest_of_parallel_links_is_taken(self, model, seed):
        net = network(
            ("z", "a", "b", 1.0), ("m10", "a", "b", 1.0), ("m2", "a", "b", 1.0), seed=seed
        )

        assert way(model, net, "a", "b") == ["m10"]

    def test_the_first_predecessor_is_kept_among_equal_routes(self, model, seed):
        net = network(
            ("1", "a", "c", 1.0),
            ("2", "a", "b", 1.0),
            ("3", "c", "d", 1.0),
            ("4", "b", "d", 1.0),
            seed=seed,
        )

        expands_by_node_id = model is not MinimumHopRouting
        assert way(model, net, "a", "d") == (["2", "4"] if expands_by_node_id else ["1", "3"])

    def test_node_ids_compare_as_text(self, model, seed):
        net = network(
            ("1", "s", "n2", 1.0),
            ("2", "s", "n10", 1.0),
            ("3", "n2", "t", 1.0),
            ("4", "n10", "t", 1.0),
            nodes=("s", "n2", "n10", "t"),
            seed=seed,
        )

        assert way(model, net, "s", "t") == (
            ["1", "3"] if model is MinimumHopRouting else ["2", "4"]
        )

    def test_a_link_without_bandwidth_is_not_used(self, model, seed):
        net = network(
            ("1", "a", "b", 0.0), ("2", "a", "c", 1.0, 5.0), ("3", "c", "b", 1.0, 5.0), seed=seed
        )

        assert way(model, net, "a", "b") == ["2", "3"]
        assert way(model, net, "a", "d") is None
        assert way(model, net, "a", "a") == []


def test_widest_path_has_no_second_objective():
    """A wide detour found first is kept although a direct link is just as wide."""
    net = network(
        ("1", "a", "b", 9.0), ("2", "b", "c", 5.0), ("3", "c", "d", 5.0), ("4", "a", "d", 5.0)
    )

    assert way(WidestPathRouting, net, "a", "d") == ["4"]

    wide_first_hop = network(("1", "a", "b", 9.0), ("2", "b", "d", 5.0), ("4", "a", "d", 4.0))
    assert way(WidestPathRouting, wide_first_hop, "a", "d") == ["1", "2"]


def test_a_wider_route_replaces_a_narrower_one_found_first():
    net = network(("1", "a", "d", 1.0), ("2", "a", "b", 3.0), ("3", "b", "d", 2.0))

    assert way(WidestPathRouting, net, "a", "d") == ["2", "3"]


def test_minimum_hop_ignores_bandwidth_and_latency():
    net = network(("1", "a", "d", 0.1, 99.0), ("2", "a", "b", 9.0), ("3", "b", "d", 9.0))

    assert way(MinimumHopRouting, net, "a", "d") == ["1"]


def test_shortest_path_takes_the_faster_detour():
    net = network(("1", "a", "d", 9.0, 3.0), ("2", "a", "b", 1.0, 1.0), ("3", "b", "d", 1.0, 1.0))

    assert way(ShortestPathRouting, net, "a", "d") == ["2", "3"]


def test_a_search_leaves_no_arrival_at_the_source():
    net = network(("1", "a", "b", 1.0), ("2", "b", "a", 1.0))

    arrivals = breadth_first(net, 0)

    assert arrivals == [None, 0, None, None]
    assert route_to(0, 0, arrivals, net) == ()
    assert route_to(3, 0, arrivals, net) is None


def test_an_infinite_start_does_not_leak_into_a_route():
    net = network(("1", "a", "b", math.nextafter(0.0, 1.0)))

    assert way(WidestPathRouting, net, "a", "b") == ["1"]
