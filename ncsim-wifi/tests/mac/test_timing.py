import math

import pytest
from ncsim_wifi.mac.efficiency import station_goodput_MBps
from ncsim_wifi.mac.timing import AxTiming, FhssTiming, data_frame_us


@pytest.mark.parametrize(("rate_Mbps", "symbols"), [(8.6, 106), (68.8, 14), (143.4, 7)])
def test_a_data_frame_is_a_preamble_and_whole_symbols(rate_Mbps, symbols):
    assert data_frame_us(rate_Mbps) == pytest.approx(44.0 + 13.6 * symbols)


def test_basic_access_adds_sifs_ack_aifs_and_propagation():
    extra_us = AxTiming().success_us(68.8) - data_frame_us(68.8)

    assert extra_us == pytest.approx(16 + 28 + 43 + 0.2)
    assert AxTiming().collision_us(68.8) == pytest.approx(AxTiming().success_us(68.8) - 0.1)


def test_rts_and_cts_lengthen_success_and_shorten_collisions():
    basic, handshake = AxTiming(), AxTiming(rts_cts=True)

    extra_us = handshake.success_us(8.6) - basic.success_us(8.6)
    assert extra_us == pytest.approx(28 + 28 + 32 + 0.2)
    assert handshake.collision_us(8.6) == pytest.approx(28 + 16 + 28 + 43 + 0.1)


def test_bianchis_own_durations_add_up():
    timing = FhssTiming()

    assert timing.success_us(1.0) == 400 + 8184 + 1 + 28 + 240 + 1 + 128
    assert timing.collision_us(1.0) == 400 + 8184 + 128 + 1


def test_a_rate_next_to_nothing_never_ends_a_frame_and_delivers_nothing():
    assert data_frame_us(5e-324) == math.inf
    assert station_goodput_MBps(1, 5e-324, AxTiming()) == 0.0
