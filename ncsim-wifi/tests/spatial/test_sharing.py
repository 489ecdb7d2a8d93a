"""Shares of a capacity, and of stations, against what fairness means."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_wifi.spatial.sharing import Sharing, greedy_shares


def shares_of(capacity, demands, costs):
    """Return what each gets: no more than it asks, nor than it could get if it asked for all."""
    could = greedy_shares(demands, costs, capacity)
    return [min(pair) for pair in zip(demands, could, strict=True)]


demands = st.lists(st.floats(0.1, 50.0), min_size=1, max_size=6)


@given(demands, st.floats(0.0, 100.0, allow_subnormal=False), st.randoms(use_true_random=False))
def test_nobody_gets_more_than_asked_and_who_gets_less_gets_as_much_as_anybody(
    asked, capacity, random
):
    costs = [random.uniform(0.5, 3.0) for _ in asked]

    shares = shares_of(capacity, asked, costs)

    spent = sum(share * cost for share, cost in zip(shares, costs, strict=True))
    assert spent <= capacity * (1 + 1e-9)
    for share, demand in zip(shares, asked, strict=True):
        assert share <= demand
        if share < demand * (1 - 1e-9):
            assert share >= max(shares) * (1 - 1e-9)
            assert spent == pytest.approx(capacity)


def test_endless_demands_share_equally():
    assert shares_of(10.0, [math.inf] * 4, [1.0] * 4) == [2.5] * 4


def test_a_station_serves_its_links_in_turn_and_a_link_its_transfers():
    sharing = Sharing([(0,), (1,), (1,)], {0: 0, 1: 0})

    rates = [rate for rate, _ in sharing.divide({0: 6.0, 1: 6.0})]

    assert rates == [3.0, 1.5, 1.5]


def test_who_is_held_up_elsewhere_leaves_the_rest_to_others():
    sharing = Sharing([(0, 1), (0,)], {0: 0, 1: 1})

    assert sharing.divide({0: 6.0, 1: 1.0}) == [(1.0, 1), (5.0, 0)]


def test_a_link_that_delivers_nothing_stops_its_transfer_and_no_other():
    sharing = Sharing([(0, 1), (2,)], {0: 0, 1: 1, 2: 0})

    assert sharing.divide({0: 6.0, 1: 0.0, 2: 6.0}) == [(0.0, 1), (6.0, 2)]
