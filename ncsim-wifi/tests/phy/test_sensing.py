import numpy as np
import pytest
from ncsim_wifi.phy.sensing import carrier_sensing_range_m, is_sensed
from ncsim_wifi.propagation import power_matrix_dBm
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation.scenes import single


def test_the_sensing_range_is_the_published_one():
    assert carrier_sensing_range_m(Radio()) == pytest.approx(71.2242, abs=5e-5)


def test_power_at_the_threshold_is_sensed():
    assert is_sensed(np.array([-82.1, -82.0, -81.9]), -82.0).tolist() == [False, True, True]


@pytest.mark.parametrize(("factor", "expected"), [(1 - 1e-9, True), (1 + 1e-9, False)])
def test_the_range_is_where_sensing_ends(factor, expected):
    radio = Radio()
    network = single(carrier_sensing_range_m(radio) * factor).network()

    power_dBm = power_matrix_dBm(network, radio, seed=1)[0, 1]

    assert bool(is_sensed(power_dBm, radio.cca_threshold_dBm)) is expected
