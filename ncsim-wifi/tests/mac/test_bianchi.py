from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.errors import ConvergenceError
from ncsim_wifi.mac import bianchi
from ncsim_wifi.mac.bianchi import (
    collision_probability,
    fixed_point,
    residual,
    transmission_probability,
)
from ncsim_wifi.validation.decimal_solver import decimal_tau


def test_a_lone_station_never_collides():
    assert fixed_point(1) == (2 / 17, 0.0)


@given(st.integers(1, 5000), st.sampled_from([8, 16, 32, 128]), st.integers(0, 8))
def test_the_residual_is_met_for_any_number_of_stations(stations, window, stage):
    point = fixed_point(stations, window, stage)

    assert abs(residual(point.p, stations, window, stage)) <= 1e-13
    assert point.tau == transmission_probability(point.p, window, stage)
    assert point.p == pytest.approx(collision_probability(point.tau, stations), abs=1e-13)


@pytest.mark.parametrize("stations", [2, 8, 20, 50, 100, 101, 256, 1000])
def test_sixty_decimal_digits_agree(stations):
    assert fixed_point(stations).tau == pytest.approx(float(decimal_tau(stations)), rel=1e-13)


def test_more_stations_collide_more_and_transmit_less():
    points = [fixed_point(n) for n in range(1, 200)]

    assert all(a.p < b.p and a.tau > b.tau for a, b in pairwise(points))


def test_the_finite_sum_has_no_singularity_at_one_half():
    around = [transmission_probability(p, 16, 6) for p in (0.5 - 1e-9, 0.5, 0.5 + 1e-9)]

    assert around == sorted(around, reverse=True)
    assert around[0] == pytest.approx(around[2])


def test_a_residual_that_is_not_met_is_an_error(monkeypatch):
    monkeypatch.setattr(bianchi, "MAX_STEPS", 10)

    with pytest.raises(ConvergenceError, match=r"n=7, W=24, m=6: residual"):
        fixed_point(7, 24)
