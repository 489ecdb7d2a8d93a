import numpy as np
import pytest
from ncsim_wifi.phy.shadowing import pair_draws, shadowing_dB

IDS = [f"n{i}" for i in range(60)]


def test_draws_are_standard_normal():
    draws = pair_draws(IDS, 42)[np.triu_indices(len(IDS), 1)]

    assert draws.mean() == pytest.approx(0.0, abs=0.08)
    assert draws.std() == pytest.approx(1.0, abs=0.06)


def test_shadowing_is_symmetric_and_none_on_the_diagonal():
    loss_dB = shadowing_dB(IDS[:5], 4.0, seed=7)

    assert (loss_dB == loss_dB.T).all()
    assert not loss_dB.diagonal().any()
    assert np.count_nonzero(loss_dB) == 20


def test_adding_a_node_or_listing_otherwise_changes_no_draw():
    before_dB = shadowing_dB(["a", "b", "c"], 6.0, seed=3)
    after_dB = shadowing_dB(["c", "new", "b", "a"], 6.0, seed=3)

    assert after_dB[np.ix_([3, 2, 0], [3, 2, 0])].tolist() == before_dB.tolist()


def test_another_seed_draws_anew_and_sigma_only_scales():
    one, same, other = (shadowing_dB(["a", "b"], s, k) for s, k in ((1.0, 1), (3.0, 1), (1.0, 2)))

    assert same[0, 1] == 3.0 * one[0, 1]
    assert other[0, 1] != one[0, 1]


def test_pairs_that_share_a_node_are_not_alike():
    draws = pair_draws(IDS, 1)
    off_diagonal = ~np.eye(len(IDS), dtype=bool)

    together = np.corrcoef(draws[0][2:], draws[1][2:])[0, 1]

    assert abs(together) < 0.4
    assert len(np.unique(draws[off_diagonal])) == len(IDS) * (len(IDS) - 1) // 2


def test_no_sigma_means_no_shadowing():
    assert not shadowing_dB(IDS, 0.0, seed=1).any()


def test_draws_are_the_same_in_every_version_and_on_every_machine():
    draws = pair_draws(["n0", "n1", "relay"], 42)

    assert draws[0, 1:].tolist() == pytest.approx([-1.74473497977, 0.49683274791])
    assert draws[1, 2] == pytest.approx(-2.56137043787)
