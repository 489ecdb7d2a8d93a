"""Who hears whom."""

from ncsim_wifi.phy.path_loss import REFERENCE_DISTANCE_m, reference_loss_dB
from ncsim_wifi.quantities import BoolArray, FloatArray
from ncsim_wifi.radio import Radio


def carrier_sensing_range_m(radio: Radio) -> float:
    """Return the distance up to which a transmission is sensed, without shadowing.

    Source: Eq. 5 (``eq:csrange``).

    >>> round(carrier_sensing_range_m(Radio()), 4)
    71.2242
    """
    spare_dB = radio.tx_power_dBm - radio.cca_threshold_dBm - reference_loss_dB(radio.freq_ghz)
    return float(REFERENCE_DISTANCE_m * 10.0 ** (spare_dB / (10.0 * radio.path_loss_exponent)))


def is_sensed(received_power_dBm: FloatArray, cca_threshold_dBm: float) -> BoolArray:
    """Return where a transmission makes the channel busy: at the CCA threshold and above.

    Source: SPEC 4; Section IV-F (``sec:wifi``), carrier sensing.
    """
    return received_power_dBm >= cca_threshold_dBm
