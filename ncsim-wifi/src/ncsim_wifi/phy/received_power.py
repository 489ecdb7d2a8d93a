"""What arrives at a receiver, and how it compares with noise and interference."""

from ncsim_wifi.quantities import Quantity, dBm_from_mW, mW_from_dBm


def received_power_dBm(tx_power_dBm: float, path_loss_dB: Quantity) -> Quantity:
    """Return the received power.

    Source: Eq. 3 (``eq:rxpower``).

    >>> received_power_dBm(20.0, 90.75)
    -70.75
    """
    return tx_power_dBm - path_loss_dB


def snr_dB(signal_dBm: Quantity, noise_floor_dBm: float) -> Quantity:
    """Return the signal-to-noise ratio.

    Source: SNR = P_rx - N_0, below Eq. 3 (``eq:rxpower``).

    >>> snr_dB(-70.75, -95.0)
    24.25
    """
    return signal_dBm - noise_floor_dBm


def sinr_dB(signal_dBm: Quantity, noise_floor_dBm: float, interference_mW: Quantity) -> Quantity:
    """Return the signal-to-interference-and-noise ratio.

    Source: Eq. 9 (``eq:sinr``).

    Args:
        signal_dBm: Received power of the link itself.
        noise_floor_dBm: Noise floor.
        interference_mW: Sum of the received powers of the hidden interferers.

    >>> round(sinr_dB(-70.0, -95.0, 0.0), 9)
    25.0
    """
    return signal_dBm - dBm_from_mW(mW_from_dBm(noise_floor_dBm) + interference_mW)


def tolerable_interference_mW(
    signal_dBm: Quantity, noise_floor_dBm: float, threshold_dB: float
) -> Quantity:
    """Return the interference at which the SINR just meets a threshold; negative if none does.

    Source: Eq. 9 (``eq:sinr``) solved for the sum, so that comparing needs no logarithm.
    """
    return mW_from_dBm(signal_dBm - threshold_dB) - mW_from_dBm(noise_floor_dBm)
