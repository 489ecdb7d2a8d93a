"""Transfers over several hops: the limits that must be exact, and what lies between."""

from dataclasses import replace

import numpy as np
import pytest
from ncsim_core.network import Network
from ncsim_core.testing.builders import grid, line, make_context, parallel_links
from ncsim_wifi.interference_models.csma_spatial import csma_spatial
from ncsim_wifi.spatial.relay import clique_efficiency

CLEAN_MBps = 10.0


def chain(hops, spacing_m=30.0):
    return line(hops + 1, bandwidth_MBps=None, spacing_m=spacing_m)


def forward(hops, start=0):
    """Return the route along a line of nodes, whose links come in pairs."""
    return tuple(2 * hop for hop in range(start, start + hops))


def rates(network, routes, **options):
    return csma_spatial(make_context(network), **options).route_rates(sorted(routes))


def test_transfers_of_one_hop_get_what_their_saturated_links_get_and_share_it():
    network = parallel_links(4, 80.0)
    model = csma_spatial(make_context(network))

    answer = model.route_rates([(0,), (0,), (1,), (3,)])

    factor = model.factors([0, 1, 3], [0, 1, 3])
    expected = CLEAN_MBps * factor[[0, 0, 1, 2]] / [2, 2, 1, 1]
    assert answer.rates_MBps.tolist() == expected.tolist()
    assert answer.bottlenecks == (0, 0, 1, 3)


@pytest.mark.parametrize("hops", [2, 3])
def test_hops_that_all_conflict_share_their_air_by_the_clique_rule(hops):
    answer = rates(chain(hops), [forward(hops)])

    expected = CLEAN_MBps * clique_efficiency(hops, rts_cts=False) / hops
    assert answer.rates_MBps[0] == pytest.approx(expected)


def test_far_transfers_do_not_slow_each_other():
    network = chain(200)
    both = rates(network, [forward(3), forward(3, start=190)]).rates_MBps

    alone = rates(network, [forward(3)]).rates_MBps[0]
    assert both.tolist() == [alone, alone]


def test_the_same_route_twice_gives_two_equal_shares_of_at_most_one():
    once = rates(chain(4), [forward(4)]).rates_MBps[0]
    first, second = rates(chain(4), [forward(4)] * 2).rates_MBps

    assert first == second
    assert 0.4 * once < first < 0.5 * once * (1 + 1e-9)


def test_a_station_beside_the_last_hop_starves_a_chain_as_it_does_in_packets():
    """A hidden sender beside the last receiver: ns-3 leaves the chain 0.01 of 1.27 MB/s."""
    network = chain(5)

    starved, single = rates(network, [forward(3), (8,)]).rates_MBps

    assert starved < 0.05 * rates(network, [forward(3)]).rates_MBps[0]
    assert single > 0.9 * CLEAN_MBps


def test_a_wired_hop_limits_a_route_and_costs_no_air():
    radio = chain(2)
    links = (replace(radio.links[0]), *radio.links[1:2], replace(radio.links[2], medium="wired"))
    network = Network(radio.nodes, (*links, *radio.links[3:])).with_rates(
        replace(radio.rates, bandwidth_MBps=(10.0, 10.0, 3.0, 10.0))
    )

    answer = rates(network, [(0, 2)])

    assert answer.rates_MBps.tolist() == [3.0]
    assert answer.bottlenecks == (2,)


def test_wires_alone_are_shared_equally():
    radio = chain(2)
    links = tuple(replace(each, medium="wired") for each in radio.links)
    network = Network(radio.nodes, links).with_rates(radio.rates)

    answer = rates(network, [(0, 2), (0,)])

    assert answer.rates_MBps.tolist() == [5.0, 5.0]


def test_without_relaying_routes_are_left_to_the_engine():
    model = csma_spatial(make_context(chain(3)), relaying=False)

    assert not model.decides_routes


def test_order_of_routes_changes_no_bit():
    network = grid(4, 4, bandwidth_MBps=None, spacing_m=40.0)
    model = csma_spatial(make_context(network))
    routes = [(0, 2), (8, 12, 20), (30,), (5, 1)]

    straight = model.route_rates(routes).rates_MBps
    backwards = csma_spatial(make_context(network)).route_rates(routes[::-1]).rates_MBps

    assert np.array_equal(straight, backwards[::-1])
