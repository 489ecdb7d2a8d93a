"""All links of a network as the model sees them, whether active or not: what never changes."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ncsim_wifi.mac.timing import (
    ACK_us,
    AIFS_us,
    CTS_us,
    PAYLOAD_bits,
    PREAMBLE_us,
    PROPAGATION_us,
    RTS_us,
    SIFS_us,
    SLOT_us,
    data_frame_us,
)
from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray, mW_from_dBm
from ncsim_wifi.spatial.backoff import FIRST_MEAN_COUNT
from ncsim_wifi.spatial.hazard import hazard
from ncsim_wifi.spatial.settings import Settings

WEAKEST_dBm = -101.0  # MODEL 1: powers below do nothing
SLOW_ACK_us = 44.0  # at 6 Mb/s, which answers data of the slowest scheme
PAYLOAD_MB_us_per_s = PAYLOAD_bits / 8  # bytes/us = MB/s


@dataclass(frozen=True)
class Plant:
    """All links of a network that use a radio.

    Args:
        ids: Name of each link; results never depend on any other order.
        source: Sending node of each link.
        target: Receiving node of each link.
        scheme: Row of the hazard table of each link.
        rate_Mbps: PHY rate of each link, 0 for links that cannot be used.
        power_dBm: Received power by (sending node, receiving node).
        settings: What is the same for all links.
    """

    ids: tuple[str, ...]
    source: IntArray
    target: IntArray
    scheme: IntArray
    rate_Mbps: FloatArray
    power_dBm: FloatArray
    settings: Settings

    @cached_property
    def power_mW(self) -> FloatArray:
        """Return the received power between nodes, 0 where it is too weak to matter."""
        return np.where(self.power_dBm < WEAKEST_dBm, 0.0, mW_from_dBm(self.power_dBm))

    @cached_property
    def noise_mW(self) -> float:
        """Return the noise floor."""
        return mW_from_dBm(self.settings.noise_dBm)

    @cached_property
    def signal_dBm(self) -> FloatArray:
        """Return the received power of each link at its receiver."""
        return self.power_dBm[self.source, self.target]

    @cached_property
    def is_alive(self) -> BoolArray:
        """Return which links can be used at all."""
        alive: BoolArray = self.rate_Mbps > 0.0
        if self.settings.terms.dead_below_threshold:
            alive &= self.signal_dBm >= self.settings.preamble_dBm
        return alive

    @cached_property
    def data_us(self) -> FloatArray:
        """Return the duration of the data frames of each link, T_D (MODEL 1)."""
        rates_Mbps = np.where(self.rate_Mbps > 0.0, self.rate_Mbps, 1.0)
        return np.array([data_frame_us(rate_Mbps) for rate_Mbps in rates_Mbps.tolist()])

    @cached_property
    def protected_us(self) -> FloatArray:
        """Return the part of each frame that the data scheme protects, V_p (MODEL 1)."""
        return self.data_us - PREAMBLE_us

    @cached_property
    def ack_us(self) -> FloatArray:
        """Return how long acknowledgements of each link take, T_A (MODEL 1)."""
        return np.where(self.scheme == 0, SLOW_ACK_us, ACK_us)

    @cached_property
    def overhead_us(self) -> FloatArray:
        """Return the time from the end of data until the sender may count again (MODEL 1)."""
        return SIFS_us + self.ack_us + 2 * PROPAGATION_us + AIFS_us

    @cached_property
    def on_air_us(self) -> FloatArray:
        """Return the time on the air before the acknowledgement, T_X (MODEL 1)."""
        handshake_us = RTS_us + CTS_us + 2 * SIFS_us if self.settings.rts_cts else 0.0
        return self.data_us + handshake_us

    @cached_property
    def solo_MBps(self) -> FloatArray:
        """Return the goodput of each link alone, without noise: B of MODEL 5."""
        cycle_us = self.on_air_us + self.overhead_us + FIRST_MEAN_COUNT * SLOT_us
        return np.where(self.is_alive, PAYLOAD_MB_us_per_s / cycle_us, 0.0)

    @cached_property
    def noise_hazard(self) -> FloatArray:
        """Return the hazard of each link without interference."""
        return hazard(self.scheme, self.signal_dBm - self.settings.noise_dBm)

    @cached_property
    def rank(self) -> IntArray:
        """Return the place of each link in the order of names."""
        order = sorted(range(len(self.ids)), key=self.ids.__getitem__)
        rank = np.empty(len(self.ids), np.int64)
        rank[order] = np.arange(len(self.ids))
        return rank

    @cached_property
    def is_coupled(self) -> BoolArray:
        """Return which links can influence each other at all, shape (links, links)."""
        heard = self.power_mW > 0.0
        np.fill_diagonal(heard, val=True)
        reaches = heard[self.source] | heard[self.target]
        return reaches[:, self.source] | reaches[:, self.target]

    def in_order(self, links: Sequence[int]) -> list[int]:
        """Return links sorted by name."""
        return sorted(links, key=self.rank.tolist().__getitem__)
