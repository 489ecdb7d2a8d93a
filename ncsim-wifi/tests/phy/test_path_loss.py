import numpy as np
import pytest
from ncsim_wifi.phy.path_loss import distances_m, path_loss_dB, reference_loss_dB


def test_friis_loss_at_one_metre_uses_the_rounded_speed_of_light():
    assert reference_loss_dB(5.0) == pytest.approx(46.4212, abs=5e-5)


def test_less_than_a_metre_counts_as_a_metre():
    assert path_loss_dB(0.0, 46.42, 3.0) == path_loss_dB(1.0, 46.42, 3.0) == 46.42


def test_ten_times_the_distance_costs_ten_times_the_exponent():
    losses_dB = path_loss_dB(np.array([2.0, 20.0, 200.0]), 40.0, 3.5)

    assert np.diff(losses_dB) == pytest.approx([35.0, 35.0])


def test_distances_are_symmetric_with_a_zero_diagonal():
    apart_m = distances_m(np.array([[0.0, 0.0], [3.0, 4.0], [0.0, 8.0]]))

    assert apart_m.tolist() == [[0.0, 5.0, 8.0], [5.0, 0.0, 5.0], [8.0, 5.0, 0.0]]


def test_places_too_far_apart_for_numbers_hear_nothing_of_each_other():
    apart_m = distances_m(np.array([[-1e308, 0.0], [1e308, 0.0]]))

    assert path_loss_dB(apart_m, 46.0, 3.0)[0, 1] == np.inf
