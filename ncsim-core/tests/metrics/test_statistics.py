"""Definitions by which policies are compared, on cases worked out by hand."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.metrics.statistics import (
    MeanInterval,
    is_rank_inversion,
    mean_interval,
    median,
    paired_differences,
    ratios_to_best,
    regret,
    slowdown,
    solo_choice,
    winner_set,
)
from ncsim_core.metrics.student_t import incomplete_beta, t_quantile

MAKESPANS_s = st.dictionaries(
    st.sampled_from("abcdef"), st.none() | st.floats(1e-3, 1e6), min_size=1
)


def test_policies_within_a_microsecond_tie():
    assert winner_set({"a": 1.0, "b": 1.000001, "c": 1.0000011}) == ("a", "b")


def test_long_makespans_tie_within_a_millionth():
    assert winner_set({"a": 1000.0, "b": 1000.001, "c": 1000.0011}) == ("a", "b")


def test_a_run_that_did_not_complete_wins_nothing():
    assert winner_set({"a": None, "b": 2.0}) == ("b",)
    assert winner_set({"a": None}) == ()


def test_a_change_within_a_tie_is_no_inversion():
    assert is_rank_inversion({"a": 1.0, "b": 1.0}, {"a": 5.0, "b": 4.0}) is False
    assert is_rank_inversion({"a": 1.0, "b": 2.0}, {"a": 5.0, "b": 4.0}) is True
    assert is_rank_inversion({"a": None}, {"a": 1.0}) is None


def test_regret_takes_the_first_solo_winner_in_the_stated_order():
    solo, full = {"a": 1.0, "b": 1.0, "c": 2.0}, {"a": 6.0, "b": 5.0, "c": 4.0}

    assert solo_choice(solo) == "a"
    assert regret(solo, full) == pytest.approx(0.5)
    assert regret(solo, full, order=["b", "a", "c"]) == pytest.approx(0.25)


def test_the_papers_largest_regret():
    solo = {"heft": 1.0, "cpop": 2.0, "round_robin": 3.0}
    full = {"heft": 108.04, "cpop": 120.0, "round_robin": 70.94}

    assert regret(solo, full) == pytest.approx(0.523, abs=5e-4)


def test_regret_is_unknown_when_the_choice_does_not_complete():
    assert regret({"a": 1.0, "b": 2.0}, {"a": None, "b": 3.0}) is None
    assert regret({"a": None}, {"a": 1.0}) is None


@given(MAKESPANS_s, MAKESPANS_s)
def test_regret_is_never_negative_and_zero_without_inversion_of_a_sole_winner(solo, full):
    value = regret(solo, full)

    if value is not None:
        assert value >= 0
        if is_rank_inversion(solo, full) is False and len(winner_set(solo)) == 1:
            assert value <= 1e-3 + 1e-6


@given(MAKESPANS_s)
def test_winners_have_ratio_one(makespans_s):
    ratios = ratios_to_best(makespans_s)

    assert all(ratios[policy] <= 1 + 1e-3 for policy in winner_set(makespans_s))
    assert {policy for policy, ratio in ratios.items() if ratio is None} == {
        policy for policy, makespan_s in makespans_s.items() if makespan_s is None
    }


def test_slowdown_needs_both_runs():
    assert slowdown(9.0, 3.0) == 3.0
    assert slowdown(None, 3.0) is None
    assert slowdown(0.0, 0.0) == 1.0
    assert slowdown(1.0, 0.0) == math.inf


@pytest.mark.parametrize(
    ("probability", "degrees", "value"),
    [  # printed tables of Student's t
        (0.95, 1, 6.313752),
        (0.975, 1, 12.706205),
        (0.975, 2, 4.302653),
        (0.975, 9, 2.262157),
        (0.995, 29, 2.756386),
        (0.9995, 5, 6.868827),
        (0.975, 1000, 1.962339),
        (0.5, 7, 0.0),
        (0.025, 9, -2.262157),
    ],
)
def test_t_quantiles_are_those_of_printed_tables(probability, degrees, value):
    assert t_quantile(probability, degrees) == pytest.approx(value, abs=6e-7)


def test_one_degree_of_freedom_is_the_cauchy_distribution():
    for probability in (0.6, 0.9, 0.999, 1 - 1e-9):
        exact = math.tan(math.pi * (probability - 0.5))
        assert t_quantile(probability, 1) == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize(("probability", "degrees"), [(0.0, 3), (1.0, 3), (0.5, 0)])
def test_impossible_quantiles_are_refused(probability, degrees):
    with pytest.raises(ValueError, match="no t quantile"):
        t_quantile(probability, degrees)


@given(st.floats(0.001, 0.999), st.floats(0.5, 50), st.floats(0.5, 50))
def test_incomplete_beta_is_symmetric(x, a, b):
    assert incomplete_beta(x, a, b) == pytest.approx(1 - incomplete_beta(1 - x, b, a), abs=1e-9)


def test_a_mean_says_how_many_runs_were_left_out():
    interval = mean_interval([1.0, None, 2.0, 3.0, None])

    assert (interval.mean, interval.count, interval.left_out) == (2.0, 3, 2)
    assert interval.high - 2.0 == pytest.approx(4.302653 / math.sqrt(3), abs=1e-6)
    assert 2.0 - interval.low == pytest.approx(interval.high - 2.0)


def test_one_value_has_a_mean_but_no_interval():
    assert mean_interval([4.0]) == MeanInterval(4.0, None, None, 1, 0)
    assert mean_interval([None]) == MeanInterval(None, None, None, 0, 1)


def test_a_median_leaves_missing_runs_out():
    assert (median([3.0, None, 1.0, 2.0]).median, median([None]).median) == (2.0, None)


def test_differences_are_taken_within_pairs_that_both_completed():
    assert paired_differences([1.0, None, 3.0], [2.0, 2.0, None]) == [1.0, None, None]
    with pytest.raises(ValueError, match="argument 2 is shorter"):
        paired_differences([1.0], [])
