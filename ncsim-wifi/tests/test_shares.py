import pytest
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.shares import Shares


def test_shares_with_a_floor_never_fall_below_it():
    shares = Shares(AxTiming(), outage_floor_factor=0.01)

    assert shares.factor(68.8, 0.0, 4) == 0.01
    assert shares.factor(68.8, 68.8, 2) == Shares(AxTiming()).factor(68.8, 68.8, 2)


def test_an_unusable_link_has_factor_one_alone():
    assert Shares(AxTiming()).factor(0.0, 0.0, 1) == pytest.approx(1.0)
    assert Shares(AxTiming()).factor(0.0, 0.0, 2) == 0.0
