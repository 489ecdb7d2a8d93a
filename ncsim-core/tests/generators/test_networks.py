import math

import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.generators.amounts import Uniform
from ncsim_core.generators.catalogue import NETWORKS
from ncsim_core.generators.making import depends_on_seed, network_from
from ncsim_core.generators.networks import (
    Clusters,
    Equipment,
    clustered,
    grid,
    is_connected,
    line,
    network_of,
    random_geometric,
    ring,
    star,
)
from ncsim_core.generators.paper import paper_grid
from ncsim_core.generators.streams import Draws

SEEDS = range(20)


def apart_m(network, a, b):
    here, there = network.nodes[a].position, network.nodes[b].position
    return math.hypot(here.x_m - there.x_m, here.y_m - there.y_m)


def undirected(shape):
    return {tuple(sorted(pair)) for pair in shape.pairs}


@pytest.mark.parametrize("size", [1, 2, 3, 4, 5])
def test_the_grid_is_by_default_the_grid_of_the_paper(size):
    assert network_of(grid(size, size)) == paper_grid(size)
    assert network_from({"type": "paper_grid", "size": size}, Draws()) == paper_grid(size)


@pytest.mark.parametrize(("diagonals", "pairs"), [("none", 12), ("checkerboard", 16), ("all", 20)])
def test_no_every_other_or_every_square_has_diagonals(diagonals, pairs):
    assert len(undirected(grid(3, 3, diagonals=diagonals))) == pairs


def test_grids_need_not_be_square():
    shape = grid(2, 3, diagonals="none")

    assert undirected(shape) == {(0, 1), (1, 2), (3, 4), (4, 5), (0, 3), (1, 4), (2, 5)}


def test_a_line_links_each_node_to_the_next():
    network = network_of(line(4, spacing_m=10))

    assert [link.id for link in network.links[:2]] == ["l_n0_n1", "l_n1_n0"]
    assert len(network.links) == 6
    assert apart_m(network, 0, 3) == 30


def test_neighbours_on_a_ring_are_equally_far_apart():
    network = network_of(ring(5, spacing_m=10))

    assert len(network.links) == 10
    assert [apart_m(network, k, (k + 1) % 5) for k in range(5)] == pytest.approx([10.0] * 5)


def test_a_star_has_all_links_at_its_middle():
    network = network_of(star(6, radius_m=25))

    assert {frozenset((link.source, link.target)) for link in network.links} == {
        frozenset(("n0", f"n{leaf}")) for leaf in range(1, 7)
    }
    assert [apart_m(network, 0, leaf) for leaf in range(1, 7)] == pytest.approx([25.0] * 6)


@pytest.mark.parametrize("seed", SEEDS)
def test_random_geometric_networks_are_connected_and_linked_exactly_within_range(seed):
    shape = random_geometric(Draws(seed), 12, side_m=150, range_m=70)
    network = network_of(shape)

    assert is_connected(12, shape.pairs)
    linked = undirected(shape)
    for a in range(12):
        for b in range(a + 1, 12):
            assert ((a, b) in linked) == (apart_m(network, a, b) <= 70)


def test_a_network_need_not_be_connected():
    shapes = [
        random_geometric(Draws(seed), 12, side_m=150, range_m=40, connected=False) for seed in SEEDS
    ]

    assert not all(is_connected(12, shape.pairs) for shape in shapes)


def test_a_placement_that_cannot_be_connected_is_refused_with_advice():
    with pytest.raises(ScenarioError, match="raise range_m"):
        random_geometric(Draws(1), 10, side_m=1000, range_m=1)


@pytest.mark.parametrize("seed", SEEDS)
def test_nodes_of_a_cluster_stand_together(seed):
    clusters = Clusters(3, 5, side_m=200, spread_m=5)
    shape = clustered(Draws(seed), clusters, range_m=300)

    assert len(shape.positions) == 15
    for first in (0, 5, 10):
        together = shape.positions[first : first + 5]
        assert max(abs(here.x_m - together[0].x_m) for here in together) < 60


def test_more_nodes_keep_the_places_of_the_first_ones():
    few = random_geometric(Draws(3), 5, side_m=100, range_m=30, connected=False)
    many = random_geometric(Draws(3), 9, side_m=100, range_m=30, connected=False)

    assert many.positions[:5] == few.positions


def test_drawing_capacities_does_not_move_nodes():
    parameters = {"type": "random_geometric", "nodes": 8, "side_m": 100, "range_m": 60}
    plain = network_from(parameters, Draws(7))
    drawn = network_from(parameters | {"capacities": {"low": 50, "high": 300}}, Draws(7))

    assert [node.position for node in drawn.nodes] == [node.position for node in plain.nodes]
    assert drawn.links == plain.links
    assert all(50 <= node.compute_capacity <= 300 for node in drawn.nodes)


def test_equal_seeds_make_equal_networks_and_other_seeds_others():
    make = lambda seed: network_of(  # noqa: E731
        random_geometric(Draws(seed), 8, side_m=100, range_m=60),
        Equipment(capacities=Uniform(1, 2)),
        Draws(seed),
    )

    assert make(1) == make(1)
    assert make(1) != make(2)


def test_every_generator_knows_whether_the_seed_matters():
    samples = {
        "grid": {"rows": 2, "columns": 2},
        "paper_grid": {"size": 2},
        "line": {"nodes": 3},
        "ring": {"nodes": 3},
        "star": {"leaves": 3},
        "random_geometric": {"nodes": 5, "side_m": 100, "range_m": 80},
        "clustered": {
            "clusters": 2,
            "nodes_each": 3,
            "side_m": 100,
            "spread_m": 5,
            "range_m": 90,
        },
    }
    assert samples.keys() == NETWORKS.keys()
    for name, given in samples.items():
        parameters = {"type": name, **given}
        differs = network_from(parameters, Draws(1)) != network_from(parameters, Draws(2))
        assert depends_on_seed(parameters, NETWORKS) == differs


def test_bandwidth_and_latency_can_be_given_to_all_links():
    network = network_from(
        {"type": "line", "nodes": 2, "bandwidth_MBps": 3, "latency_s": 0.25}, Draws()
    )

    assert {(link.bandwidth_MBps, link.latency_s) for link in network.links} == {(3, 0.25)}
