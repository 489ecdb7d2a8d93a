import numpy as np
import pytest
from ncsim_wifi.phy.received_power import (
    received_power_dBm,
    sinr_dB,
    snr_dB,
    tolerable_interference_mW,
)
from ncsim_wifi.quantities import dBm_from_mW, mW_from_dBm


def test_power_less_loss_is_received():
    assert received_power_dBm(20.0, np.array([90.0, 100.0])).tolist() == [-70.0, -80.0]


def test_without_interference_sinr_is_snr():
    assert sinr_dB(-70.0, -95.0, 0.0) == pytest.approx(snr_dB(-70.0, -95.0))


def test_interference_as_strong_as_noise_costs_three_decibels():
    noise_mW = mW_from_dBm(-95.0)

    assert sinr_dB(-70.0, -95.0, noise_mW) == pytest.approx(25.0 - 3.0103, abs=1e-4)


@pytest.mark.parametrize("threshold_dB", [0.0, 3.0, 17.0])
def test_the_tolerable_interference_just_meets_the_threshold(threshold_dB):
    limit_mW = tolerable_interference_mW(-70.0, -95.0, threshold_dB)

    assert sinr_dB(-70.0, -95.0, limit_mW) == pytest.approx(threshold_dB)


def test_a_threshold_above_the_snr_tolerates_less_than_nothing():
    assert tolerable_interference_mW(-90.0, -95.0, 6.0) < 0


def test_decibels_and_milliwatts_undo_each_other():
    assert dBm_from_mW(mW_from_dBm(-73.25)) == pytest.approx(-73.25)
    assert dBm_from_mW(0.0) == -np.inf
