"""The parameters of all radios in a scenario: the config section ``rf``."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

REFERENCE_CHANNEL_WIDTH_mhz = 20  # rate tables are for this width (paper, Table mcs_parameters)


@dataclass(frozen=True)
class Radio:
    """What every radio of the network has in common; one field per key of ``rf``.

    Source: paper, Appendix A (``app:timing``) and Table ``tab:ns3_params``.

    Args:
        tx_power_dBm: Transmit power.
        freq_ghz: Carrier frequency in GHz, which sets the loss at 1 m.
        path_loss_exponent: Exponent n of the log-distance law; 2 is free space.
        noise_floor_dBm: Effective noise floor, the same at every channel width.
        cca_threshold_dBm: Power at which a node finds the channel busy.
        channel_width_mhz: Channel width in MHz; rates grow in proportion.
        wifi_standard: Name of a rate table in ``tables/``.
        shadow_fading_sigma: Standard deviation of static shadowing in dB; 0 is none.
        rts_cts: Whether data frames are preceded by RTS and CTS.
        capture_margin_dB: By how much a frame's threshold lies below its selection threshold.
        interference_cutoff_dBm: Hidden interferers received below this are left out.
    """

    tx_power_dBm: float = 20.0
    freq_ghz: float = 5.0
    path_loss_exponent: float = 3.0
    noise_floor_dBm: float = -95.0
    cca_threshold_dBm: float = -82.0
    channel_width_mhz: int = 20
    wifi_standard: str = "ax"
    shadow_fading_sigma: float = 0.0
    rts_cts: bool = False
    capture_margin_dB: float = 5.0
    interference_cutoff_dBm: float = -105.0

    @classmethod
    def from_section(cls, section: Mapping[str, Any]) -> "Radio":
        """Return the radio of a config section ``rf``; missing keys take their defaults."""
        known = {field.name for field in fields(cls)}
        return cls(**{key: value for key, value in section.items() if key in known})

    @property
    def rate_scale(self) -> float:
        """Return by how much this channel width multiplies the rates of the table."""
        return self.channel_width_mhz / REFERENCE_CHANNEL_WIDTH_mhz

    def draws_from(self, seed: int) -> int | None:
        """Return the seed if results depend on it, for keys of caches."""
        return seed if self.shadow_fading_sigma > 0 else None
