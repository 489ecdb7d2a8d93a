"""The virtual network in SAGA's order."""

import pytest
from ncsim_saga.native import planning_network as module
from ncsim_saga.native.planning_network import planning_network, walk_of
from ncsim_saga.virtual_network import VirtualNetwork


def network_with(count):
    return VirtualNetwork(
        tuple(float(100 + index) for index in range(count)),
        tuple(tuple(float(1 + i * count + j) for j in range(count)) for i in range(count)),
    )


def test_speeds_between_positions_are_symmetric_and_one_of_the_two_directions():
    network = network_with(5)
    plan = planning_network(network)
    for a in range(5):
        for b in range(5):
            there = network.speed_MBps[plan.nodes[a]][plan.nodes[b]]
            back = network.speed_MBps[plan.nodes[b]][plan.nodes[a]]

            assert plan.pair_speed_MBps[a][b] == plan.pair_speed_MBps[b][a]
            assert plan.pair_speed_MBps[a][b] in (there, back)


def test_saga_uses_the_direction_that_it_walks_last():
    from ncsim_saga.translate import saga_network

    network = network_with(6)
    plan, saga = planning_network(network), saga_network(network)
    for a, source in enumerate(plan.nodes):
        for b, target in enumerate(plan.nodes):
            edge = saga.get_edge(f"n{source}", f"n{target}")

            assert plan.pair_speed_MBps[a][b] == edge.speed


def test_it_is_worked_out_once():
    network = network_with(3)

    assert planning_network(network) is planning_network(network)


@pytest.mark.parametrize("many_nodes", [1, 1000])
def test_numpy_changes_no_order(many_nodes, monkeypatch):
    expected = walk_of(12)
    monkeypatch.setattr(module, "MANY_NODES", many_nodes)

    assert walk_of.__wrapped__(12) == expected
