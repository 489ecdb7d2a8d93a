"""Builders and oracles give what their names say."""

import pytest
from ncsim_core.network import route_fault
from ncsim_core.testing import builders
from ncsim_core.testing.oracle import FewestHops, all_routes, best_value, route_value


def test_line_links_neighbours_both_ways():
    network = builders.line(3, bandwidth_MBps=4.0, latency_s=0.5, capacities=(100, 200))

    assert [link.id for link in network.links] == ["n0_n1", "n1_n0", "n1_n2", "n2_n1"]
    assert network.bandwidth_MBps == (4.0,) * 4
    assert network.latency_s == (0.5,) * 4
    assert [node.compute_capacity for node in network.nodes] == [100, 200, 100]


def test_grid_has_its_nodes_row_by_row():
    network = builders.grid(2, 3, spacing_m=10.0)

    assert [(n.position.x_m, n.position.y_m) for n in network.nodes if n.position][:4] == [
        (0, 0),
        (10, 0),
        (20, 0),
        (0, 10),
    ]
    assert len(network.links) == 2 * 7


def test_star_links_the_hub_with_each_leaf():
    network = builders.star(3)

    assert {link.source for link in network.links if link.target == "n0"} == {"n1", "n2", "n3"}
    assert len(network.links) == 6


def test_parallel_links_share_no_node():
    network = builders.parallel_links(3, 12.0)

    assert len({end for link in network.links for end in (link.source, link.target)}) == 6
    assert all(link.bandwidth_MBps is None for link in network.links)


def test_fork_join_waits_for_all_its_branches():
    dag = builders.fork_join(3, pins={0: 1})

    assert [each.target for each in dag.outgoing["T0"]] == ["T1", "T2", "T3"]
    assert [each.source for each in dag.incoming["T4"]] == ["T1", "T2", "T3"]
    assert dag.tasks[0].pinned_to == "n1"


def test_chain_and_diamond_have_their_dependencies():
    assert len(builders.chain(4).dependencies) == 3
    assert builders.diamond() == builders.fork_join(2)


def test_injection_is_in_microseconds():
    assert builders.inject(builders.chain(1), 0.25).at_us == 250_000


def test_contexts_share_no_cache():
    network = builders.line(2)

    assert builders.make_context(network).cached("k", lambda: 1) == 1
    assert builders.make_context(network).cached("k", lambda: 2) == 2


def test_snapshot_knows_routes_over_several_hops():
    snapshot = builders.make_snapshot(builders.line(3, bandwidth_MBps=5.0))

    assert snapshot.bottleneck_MBps(0, 2) == 5.0
    assert snapshot.transfer_time_s(10.0, 0, 2) == 2.0


def test_fewest_hops_is_as_short_as_the_shortest_of_all_routes():
    network = builders.grid(2, 3)

    for target in range(len(network.nodes)):
        route = FewestHops().route(0, target, network)
        assert route is not None
        assert route_fault(route, 0, target, network) is None
        assert len(route) == best_value("hops", 0, target, network)


def test_all_routes_of_a_square_are_its_two_sides():
    network = builders.grid(2, 2)

    assert sorted(len(route) for route in all_routes(0, 3, network)) == [2, 2]


@pytest.mark.parametrize(
    ("objective", "value"), [("hops", 2), ("latency", 1.0), ("bottleneck", -4)]
)
def test_value_of_a_route_depends_on_the_objective(objective, value):
    network = builders.line(3, bandwidth_MBps=4.0, latency_s=0.5)

    assert route_value(objective, (0, 2), network) == value
