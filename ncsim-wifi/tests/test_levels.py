import math
from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.testing.builders import make_context
from ncsim_wifi.levels import MAX_UNITS, levels_of
from ncsim_wifi.phy.mcs import read_table
from ncsim_wifi.phy.received_power import sinr_dB
from ncsim_wifi.propagation import propagation
from ncsim_wifi.quantities import mW_from_dBm
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation.scenes import parallel, single


def levels_at(distance_m, **rf):
    radio = Radio(**rf)
    return levels_of(propagation(make_context(single(distance_m).network()), radio), radio)


def test_without_hidden_interferers_the_clean_rate_stays():
    for distance_m in (1.0, 30.0, 100.0, 131.0):
        levels = levels_at(distance_m)
        assert levels.level(0, 0) == 0
        assert levels.hidden_factor(0, 0) == 1.0


@given(st.floats(1.0, 131.0), st.floats(-110.0, -60.0), st.sampled_from([0.0, 3.0, 5.0, 8.0]))
def test_levels_are_the_table_at_the_sinr(distance_m, interferer_dBm, margin_dB):
    levels = levels_at(distance_m, capture_margin_dB=margin_dB)
    power_mW = mW_from_dBm(interferer_dBm)
    signals = propagation(make_context(single(distance_m).network()), Radio())
    ratio_dB = sinr_dB(float(signals.signal_dBm[0]), -95.0, power_mW)
    table = read_table("ax")
    met = [
        rate
        for threshold_dB, rate in zip(table.snr_min_dB, table.rate_Mbps, strict=True)
        if ratio_dB >= threshold_dB - margin_dB
    ]
    is_close = any(abs(ratio_dB - t + margin_dB) < 1e-5 for t in table.snr_min_dB)

    (units,) = levels.units(np.array([0]), np.array([power_mW]))

    expected_Mbps = min(max(met, default=0.0), float(signals.rate_Mbps[0]))
    assert is_close or levels.effective_rate_Mbps(0, int(units)) == expected_Mbps


@given(st.floats(10.0, 100.0), st.floats(75.0, 150.0))
def test_a_threshold_that_is_met_exactly_is_met(length_m, separation_m):
    network = parallel(2, separation_m, length_m=length_m).network()
    signals = propagation(make_context(network), Radio())
    signal_dBm = float(signals.signal_dBm[0])
    power_mW = mW_from_dBm(float(signals.power_dBm[network.sources[1], network.targets[0]]))
    ratio_dB = sinr_dB(signal_dBm, -95.0, power_mW)
    table = read_table("ax")
    threshold_dB = table.snr_min_dB[table.index_for(signal_dBm + 95.0)]
    margin_dB = threshold_dB - ratio_dB
    if threshold_dB - margin_dB > ratio_dB:  # in floating point
        margin_dB = math.nextafter(margin_dB, math.inf)

    levels = levels_of(signals, Radio(capture_margin_dB=margin_dB))

    (units,) = levels.units(np.array([0]), np.array([power_mW]))
    assert levels.effective_rate_Mbps(0, int(units)) == float(signals.rate_Mbps[0])


def test_any_audible_interferer_counts_one_quantum_at_least_and_not_too_many():
    levels = levels_at(1.0)

    units = levels.units(np.array([0, 0]), np.array([1e-30, 1e9]))

    assert units.tolist() == [1, MAX_UNITS]


def test_a_written_bandwidth_above_the_table_falls_to_the_table_under_interference():
    network = single(1.0).network()
    fast = replace(network, links=(replace(network.links[0], bandwidth_MBps=100.0),))
    levels = levels_of(propagation(make_context(fast), Radio()), Radio())

    assert levels.effective_rate_Mbps(0, 0) == 800.0
    assert levels.effective_rate_Mbps(0, 1) == 143.4


def test_a_written_bandwidth_on_a_link_out_of_range_ends_with_the_first_interferer():
    network = single(500.0).network()
    far = replace(network, links=(replace(network.links[0], bandwidth_MBps=1.0),))
    levels = levels_of(propagation(make_context(far), Radio()), Radio())

    assert levels.effective_rate_Mbps(0, 0) == 8.0
    assert levels.effective_rate_Mbps(0, 1) == 0.0
