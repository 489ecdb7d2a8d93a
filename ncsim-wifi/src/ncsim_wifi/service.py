"""What is left of a link under contention and hidden interference: the paper's factors."""

from ncsim_wifi.mac.efficiency import channel_goodput_Mbps
from ncsim_wifi.mac.timing import Timing
from ncsim_wifi.phy.mcs import RateTable


def shifted_thresholds_dB(table: RateTable, margin_dB: float) -> tuple[float, ...]:
    """Return the SINR thresholds of effective service.

    Source: Eq. 10 (``eq:capture``).

    >>> shifted_thresholds_dB(RateTable((5.0, 8.0), (8.6, 17.2)), 5.0)
    (0.0, 3.0)
    """
    return tuple(threshold_dB - margin_dB for threshold_dB in table.snr_min_dB)


def hidden_factor(effective_Mbps: float, clean_Mbps: float) -> float:
    """Return the part of the clean PHY rate that hidden interferers leave.

    Source: Eq. 11 (``eq:sinr_factor``).

    >>> hidden_factor(51.6, 68.8)
    0.75
    """
    return effective_Mbps / clean_Mbps


def combined_factor(
    effective_Mbps: float, clean_Mbps: float, stations: int, timing: Timing
) -> float:
    """Return the factor on the clean solo bandwidth of a link.

    Source: Eq. 12 (``eq:combined``).

    Args:
        effective_Mbps: R_eff, at most ``clean_Mbps``; 0 is an outage.
        clean_Mbps: R, greater than 0.
        stations: n = 1 + active contenders.
        timing: Frame timing.
    """
    if effective_Mbps <= 0.0:
        return 0.0
    if stations == 1 and effective_Mbps == clean_Mbps:
        return 1.0
    served_Mbps = channel_goodput_Mbps(stations, effective_Mbps, timing)
    return served_Mbps / (stations * channel_goodput_Mbps(1, clean_Mbps, timing))
