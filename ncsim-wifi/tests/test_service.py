from hypothesis import given
from hypothesis import strategies as st
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.phy.mcs import RateTable, read_table
from ncsim_wifi.service import combined_factor, hidden_factor, shifted_thresholds_dB


def test_thresholds_are_shifted_by_the_margin():
    assert shifted_thresholds_dB(RateTable((5.0, 8.0), (1.0, 2.0)), 5.0) == (0.0, 3.0)


def test_the_hidden_factor_is_the_part_of_the_rate_that_is_left():
    assert hidden_factor(34.4, 68.8) == 0.5


def test_an_isolated_link_has_factor_one_and_an_outage_zero():
    assert combined_factor(68.8, 68.8, 1, AxTiming()) == 1.0
    assert combined_factor(0.0, 68.8, 3, AxTiming()) == 0.0


@given(
    st.sampled_from(read_table("ax").rate_Mbps),
    st.sampled_from((0.0, *read_table("ax").rate_Mbps)),
    st.integers(1, 60),
    st.booleans(),
)
def test_combined_factors_are_shares(clean_Mbps, effective_Mbps, stations, rts_cts):
    effective_Mbps = min(clean_Mbps, effective_Mbps)

    factor = combined_factor(effective_Mbps, clean_Mbps, stations, AxTiming(rts_cts))

    assert 0.0 <= factor <= 1.0
    assert combined_factor(effective_Mbps, clean_Mbps, stations + 1, AxTiming(rts_cts)) <= factor


def test_rates_of_equally_many_symbols_give_the_same_factor_to_the_last_bit():
    """114.7 and 129 Mb/s both take eight symbols; rounding once made this factor exceed 1."""
    assert combined_factor(114.7, 129.0, 1, AxTiming()) == 1.0
