"""How long frames and whole exchanges take."""

import math
from dataclasses import dataclass
from typing import Protocol

from typing_extensions import override

PAYLOAD_bits = 8 * 1472  # application payload, Appendix A (app:timing)
PSDU_bits = 8 * 1542  # with MAC, LLC/SNAP, IP, UDP, FCS and delimiter
SERVICE_AND_TAIL_bits = 16 + 6
PREAMBLE_us = 44.0
SYMBOL_us = 13.6  # with a guard interval of 800 ns
SLOT_us = 9.0
SIFS_us = 16.0
AIFS_us = 43.0
ACK_us = 28.0  # legacy OFDM control frame at 24 Mb/s
RTS_us = 28.0
CTS_us = 28.0
PROPAGATION_us = 0.1


class Timing(Protocol):
    """What contention analysis needs to know of a MAC."""

    @override
    def __hash__(self) -> int:
        """Timings are keys of caches."""

    @property
    def slot_us(self) -> float:
        """Return the duration of an idle slot."""

    @property
    def payload_bits(self) -> int:
        """Return the payload of one frame."""

    def success_us(self, rate_Mbps: float) -> float:
        """Return how long a successful exchange keeps the channel, T_S."""

    def collision_us(self, rate_Mbps: float) -> float:
        """Return how long a collision keeps the channel, T_C."""


def data_frame_us(rate_Mbps: float) -> float:
    """Return the duration of one data frame.

    Source: Appendix A (``app:timing``), Eq. 15.

    Args:
        rate_Mbps: PHY rate, greater than 0.

    >>> round(data_frame_us(68.8), 1)
    234.4
    """
    symbols = (PSDU_bits + SERVICE_AND_TAIL_bits) / (SYMBOL_us * rate_Mbps)
    if symbols == math.inf:  # a rate so small that no number says how long the frame is
        return math.inf
    return PREAMBLE_us + SYMBOL_us * math.ceil(symbols)


@dataclass(frozen=True)
class AxTiming:
    """Durations of 802.11ax exchanges, also used for the n and ac tables (SPEC 2).

    Source: Appendix A (``app:timing``), basic access and RTS/CTS.

    Args:
        rts_cts: Whether RTS and CTS precede the data frame.
    """

    rts_cts: bool = False
    slot_us: float = SLOT_us
    payload_bits: int = PAYLOAD_bits

    def success_us(self, rate_Mbps: float) -> float:
        """Return T_S, the duration of a successful exchange.

        Source: Appendix A (``app:timing``), Eqs. 16 and 18.

        >>> round(AxTiming().success_us(68.8), 1)
        321.6
        """
        basic_us = data_frame_us(rate_Mbps) + SIFS_us + ACK_us + AIFS_us + 2 * PROPAGATION_us
        if not self.rts_cts:
            return basic_us
        return basic_us + RTS_us + CTS_us + 2 * SIFS_us + 2 * PROPAGATION_us

    def collision_us(self, rate_Mbps: float) -> float:
        """Return T_C, the duration of a collision.

        Source: Appendix A (``app:timing``), Eqs. 17 and 19.

        >>> round(AxTiming(rts_cts=True).collision_us(68.8), 1)
        115.1
        """
        if self.rts_cts:
            return RTS_us + SIFS_us + CTS_us + AIFS_us + PROPAGATION_us
        return data_frame_us(rate_Mbps) + SIFS_us + ACK_us + AIFS_us + PROPAGATION_us


@dataclass(frozen=True)
class FhssTiming:
    """Durations of Bianchi's own example: FHSS at 1 Mb/s, basic access.

    Source: Section VI-B (``sec:external_val``), after Bianchi (2000), Table II.
    """

    slot_us: float = 50.0
    payload_bits: int = 8184

    _SIFS_us = 28.0
    _DIFS_us = 128.0
    _PROPAGATION_us = 1.0
    _PHY_HEADER_bits = 128
    _HEADER_bits = 272 + _PHY_HEADER_bits
    _ACK_bits = 112 + _PHY_HEADER_bits

    def success_us(self, rate_Mbps: float) -> float:
        """Return T_S: header, payload, SIFS, ACK, DIFS and two propagation delays."""
        frames_us = (self._HEADER_bits + self.payload_bits + self._ACK_bits) / rate_Mbps
        return frames_us + self._SIFS_us + self._DIFS_us + 2 * self._PROPAGATION_us

    def collision_us(self, rate_Mbps: float) -> float:
        """Return T_C: header, payload, DIFS and one propagation delay."""
        frame_us = (self._HEADER_bits + self.payload_bits) / rate_Mbps
        return frame_us + self._DIFS_us + self._PROPAGATION_us
