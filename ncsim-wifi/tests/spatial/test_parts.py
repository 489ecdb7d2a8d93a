"""Occupancy, belief, chains and sums against plain ways of computing them."""

from itertools import product

import numpy as np
import pytest
from ncsim_wifi.spatial.acks import AckRelations, Overlapped, answers_survival
from ncsim_wifi.spatial.belief import clique_belief
from ncsim_wifi.spatial.chains import STAGES, ChainRates, stationary
from ncsim_wifi.spatial.gaps import power_sums
from ncsim_wifi.spatial.groups import Members, in_company
from ncsim_wifi.spatial.hazard import hazard, hazard_table
from ncsim_wifi.spatial.occupancy import (
    exact_occupancy,
    independent_sets,
    occupancy_of,
    set_table,
)
from ncsim_wifi.spatial.overlap import joint_kill
from ncsim_wifi.spatial.relations import Hostile
from ncsim_wifi.spatial.relay import maximal_cliques


def line(count):
    senses = np.zeros((count, count), bool)
    for at in range(count - 1):
        senses[at, at + 1] = senses[at + 1, at] = True
    return senses


def test_belief_is_exact_on_a_tree_of_cliques():
    activity = np.array([3.0, 1.0, 5.0, 2.0, 0.5])

    exact = occupancy_of(line(5), 1000)(activity)
    belief = clique_belief(line(5))(activity)

    assert belief.idle == pytest.approx(exact.idle, rel=1e-5)
    two_away = np.array([0, 1, 2]), np.array([2, 3, 4])  # farther on it is approximate
    assert belief.on[two_away] == pytest.approx(exact.on[two_away], rel=1e-5)
    assert belief.clear[0, 1] == pytest.approx(exact.clear[0, 1], rel=1e-5)


def test_components_of_the_sensing_graph_are_independent():
    senses = np.zeros((4, 4), bool)
    senses[:2, :2] = senses[2:, 2:] = line(2)
    activity = np.array([3.0, 1.0, 5.0, 2.0])

    apart = occupancy_of(senses, 1000)(activity)
    every = np.arange(4), independent_sets(senses, 1000)
    together = exact_occupancy(set_table(senses, [every]), activity)

    for one, other in zip(apart, together, strict=True):
        assert one == pytest.approx(other)


def test_stationary_distribution_balances_the_whole_chain():
    rng = np.random.default_rng(1)
    rates = ChainRates(*(rng.uniform(0.1, 1.0, (STAGES, STAGES, 3)) for _ in range(5)))

    joint = stationary(rates)

    targets = [(0, None), (None, 0), (1, 1), (1, None), (None, 1)]
    for chain in range(3):
        flow = np.zeros((STAGES, STAGES))
        for rate, (da, db) in zip(rates, targets, strict=True):
            for a in range(STAGES):
                for b in range(STAGES):
                    to_a = a if da is None else (a + 1) % STAGES if da else 0
                    to_b = b if db is None else (b + 1) % STAGES if db else 0
                    moved = rate[a, b, chain] * joint[chain, a, b]
                    flow[to_a, to_b] += moved
                    flow[a, b] -= moved
        assert np.abs(flow).max() < 1e-12
        assert joint[chain].sum() == pytest.approx(1.0)


@pytest.mark.parametrize("base", [1.0, 0.9, 0.998])
def test_power_sums_are_sums(base):
    n = np.arange(1024)

    sums = power_sums(np.array(base), np.array(1023.0), np.array(base**1024))

    for power, value in enumerate(sums):
        assert value == pytest.approx((n**power * base**n).sum(), rel=1e-7)


def test_joint_kill_is_the_mean_over_all_sets_of_helpers():
    rng = np.random.default_rng(2)
    kill, omega = rng.uniform(0.0, 1.0, (2, 3, 1, 16))
    present = rng.uniform(0.0, 1.0, (3, 7, 4))

    found = joint_kill(kill, omega, present)

    for relation, stage in np.ndindex(3, 7):
        weights = [
            omega[relation, 0, held]
            * np.prod(
                [
                    x if held >> helper & 1 else 1.0 - x
                    for helper, x in enumerate(present[relation, stage])
                ]
            )
            for held in range(16)
        ]
        expected = np.dot(weights, kill[relation, 0]) / sum(weights)
        assert found[relation, stage] == pytest.approx(expected)


def group_of(count):
    """Return relations of one link whose interferers exclude each other."""
    every = np.zeros(count, np.int64)
    return Hostile(every, np.arange(count), *[every[:, None]] * 4, every, *[every] * 4)


@pytest.mark.parametrize("number", [1, 2, 3])
def test_frames_that_overlap_several_of_a_group_survive_each(number):
    phi, each = np.array([0.5, 0.3, 0.2]), np.array([0.9, 0.4, 0.05])  # survival of one overlap

    of_all_alike = np.repeat(each[:, None] ** number, STAGES, axis=1)
    share, alone = np.repeat(phi[:, None], STAGES, axis=1), np.full((3, STAGES), 1 / STAGES)
    found = in_company(
        group_of(3), Members(phi, share, alone, of_all_alike), np.full(3, float(number))
    )

    series = product(range(3), repeat=number)
    expected = sum(np.prod(phi[list(who)] * each[list(who)]) for who in series)
    assert found == pytest.approx(np.full((3, STAGES), expected))


def answered(*, hit, survives, back, prolongs=True, kill=1.0, number=40.0):
    """Return what one station's acknowledgements leave of a link; relation 1 is its own."""
    one = np.ones(1)
    ack = AckRelations(*np.zeros((2, 1), int), kill * one, one, one, np.array([0]), np.array([1]))
    met = Overlapped(
        np.array([hit, back[0]]), np.array([survives, back[1]]), np.full(2, prolongs), np.ones(2)
    )
    return answers_survival(ack, number * one, met)[0]


def test_acknowledgements_spare_frames_that_overlap_no_data():
    # 0.4 overlap nothing, 0.3 survive the overlap and then die of what answers it
    assert answered(hit=0.6, survives=0.7, back=(0.5, 0.9)) == pytest.approx(0.4 / 0.7)
    assert answered(hit=0.6, survives=0.4, back=(0.5, 0.9)) == pytest.approx(1.0)


def test_data_that_the_overlap_destroys_are_not_answered():
    assert answered(hit=0.6, survives=0.7, back=(0.5, 0.5)) == pytest.approx(1.0)


def test_acknowledgements_that_prolong_nothing_fall_into_any_frame():
    met = {"hit": 0.6, "survives": 0.7, "back": (0.5, 0.5), "prolongs": False}

    assert answered(**met, kill=0.25, number=2.0) == pytest.approx(0.75**2)


def test_hazard_meets_every_point_of_the_table():
    table = hazard_table()

    for scheme, points_dB in enumerate(table.ratio_dB):
        assert hazard(np.array(scheme), points_dB) == pytest.approx(np.exp(table.ln_hazard))


def test_maximal_cliques_of_a_triangle_with_a_tail():
    related = np.zeros((4, 4), bool)
    for one, other in [(0, 1), (0, 2), (1, 2), (2, 3)]:
        related[one, other] = related[other, one] = True

    assert sorted(tuple(sorted(c)) for c in maximal_cliques(related)) == [(0, 1, 2), (2, 3)]
