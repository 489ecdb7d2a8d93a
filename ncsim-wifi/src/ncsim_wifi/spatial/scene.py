"""The active links and their stations, and what each receives of the others."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray, dBm_from_mW
from ncsim_wifi.spatial.hazard import ln_hazard
from ncsim_wifi.spatial.plant import Plant
from ncsim_wifi.spatial.settings import Settings
from ncsim_wifi.spatial.sums import sums_by


@dataclass(frozen=True)
class Scene:
    """Active links ``l`` in the order of their names, stations ``u`` in order of first use.

    Args:
        plant: All links of the network.
        links: The active ones, sorted by name.
    """

    plant: Plant
    links: IntArray

    @cached_property
    def settings(self) -> Settings:
        """Return what is the same for all links."""
        return self.plant.settings

    @cached_property
    def _stations(self) -> tuple[IntArray, IntArray]:
        nodes = self.plant.source[self.links].tolist()
        number = {node: at for at, node in enumerate(dict.fromkeys(nodes))}
        return np.array(list(number)), np.array([number[node] for node in nodes])

    @cached_property
    def station_node(self) -> IntArray:
        """Return the node of each station."""
        return self._stations[0]

    @cached_property
    def station(self) -> IntArray:
        """Return u(l), the station of each link."""
        return self._stations[1]

    @cached_property
    def station_count(self) -> int:
        """Return the number of stations."""
        return len(self.station_node)

    def station_sums(self, values: FloatArray) -> FloatArray:
        """Return for each station the sum over its links."""
        return np.asarray(np.bincount(self.station, values, self.station_count), np.float64)

    def station_means(self, attempts: FloatArray, values: FloatArray) -> FloatArray:
        """Return for each station the mean over its links.

        Args:
            attempts: a_l, the share of each link in the attempts of its station.
            values: Shape (links, any).
        """
        if self.station_count == len(self.links):  # the shares are 1, the order is the same
            return values
        return sums_by(self.station, attempts[:, None] * values, self.station_count)

    @cached_property
    def scheme(self) -> IntArray:
        """Return the row of the hazard table of each link."""
        return self.plant.scheme[self.links]

    @cached_property
    def signal_dBm(self) -> FloatArray:
        """Return the power of each link at its receiver."""
        return self.plant.signal_dBm[self.links]

    @cached_property
    def receiver_node(self) -> IntArray:
        """Return the receiving node of each link."""
        return self.plant.target[self.links]

    @cached_property
    def is_alive(self) -> BoolArray:
        """Return which links can be used at all."""
        return self.plant.is_alive[self.links]

    @cached_property
    def data_us(self) -> FloatArray:
        """Return T_D of each link."""
        return self.plant.data_us[self.links]

    @cached_property
    def protected_us(self) -> FloatArray:
        """Return V_p of each link."""
        return self.plant.protected_us[self.links]

    @cached_property
    def ack_us(self) -> FloatArray:
        """Return T_A of each link."""
        return self.plant.ack_us[self.links]

    @cached_property
    def overhead_us(self) -> FloatArray:
        """Return ovh of each link."""
        return self.plant.overhead_us[self.links]

    @cached_property
    def on_air_us(self) -> FloatArray:
        """Return T_X of each link."""
        return self.plant.on_air_us[self.links]

    @cached_property
    def at_station_dBm(self) -> FloatArray:
        """Return P(w, u), shape (stations w, stations u)."""
        return self.plant.power_dBm[self.station_node[:, None], self.station_node]

    @cached_property
    def at_station_mW(self) -> FloatArray:
        """Return P(w, u), shape (stations w, stations u); 0 on the diagonal."""
        power_mW = self.plant.power_mW[self.station_node[:, None], self.station_node]
        np.fill_diagonal(power_mW, 0.0)
        return power_mW

    @cached_property
    def at_receiver_mW(self) -> FloatArray:
        """Return I[w, l], shape (stations, links); includes each link's own signal."""
        return self.plant.power_mW[self.station_node[:, None], self.receiver_node]

    @cached_property
    def receiver_at_station_dBm(self) -> FloatArray:
        """Return P(rx_l, w), shape (links, stations)."""
        return self.plant.power_dBm[self.receiver_node[:, None], self.station_node]

    @cached_property
    def receiver_at_receiver_mW(self) -> FloatArray:
        """Return Ia[k, l] = P(rx_k, rx_l), shape (links, links)."""
        return self.plant.power_mW[self.receiver_node[:, None], self.receiver_node]

    @cached_property
    def hears_by_power(self) -> BoolArray:
        """Return which stations sense each other by received power alone."""
        return self._sensing[0]

    @cached_property
    def silenced_by_cts(self) -> BoolArray:
        """Return which stations are kept apart by each other's CTS only ("cts2", MODEL 2)."""
        return self._sensing[1]

    @cached_property
    def senses(self) -> BoolArray:
        """Return S, which stations keep each other from sending (MODEL 2)."""
        return self.hears_by_power | self.silenced_by_cts

    @cached_property
    def _sensing(self) -> tuple[BoolArray, BoolArray]:
        by_power: BoolArray = self.at_station_dBm >= self.settings.sensing_dBm
        np.fill_diagonal(by_power, val=False)
        by_cts = np.zeros_like(by_power)
        if self.settings.rts_cts:
            unheard = (~self.hears_receiver).astype(np.float64)
            all_heard = self.link_of_station.astype(np.float64) @ unheard == 0.0
            by_cts = all_heard & all_heard.T & ~by_power
            np.fill_diagonal(by_cts, val=False)
        return by_power, by_cts

    @cached_property
    def hears_receiver(self) -> BoolArray:
        """Return hear[l, w], which stations hear the acknowledgements of which links."""
        return np.asarray(self.receiver_at_station_dBm >= self.settings.preamble_dBm)

    @cached_property
    def link_of_station(self) -> BoolArray:
        """Return which links each station has, shape (stations, links)."""
        return np.asarray(np.arange(self.station_count)[:, None] == self.station[None, :])

    @cached_property
    def decodes(self) -> BoolArray:
        """Return dec[l, w], which stations understand the data frames of which links (MODEL 2)."""
        if self.settings.rts_cts:
            return np.ones((len(self.links), self.station_count), np.bool_)
        ratio_dB = self.at_station_dBm[self.station] - self.settings.noise_dBm
        return np.asarray(ln_hazard(self.scheme[:, None], ratio_dB) < MAX_LN_HAZARD_TO_DECODE)

    @cached_property
    def degree(self) -> FloatArray:
        """Return how many stations each one senses."""
        return np.asarray(self.senses.sum(axis=1), np.float64)

    def ratio_dB(self, interference_mW: FloatArray, links: IntArray) -> FloatArray:
        """Return signal to interference, noise included in the latter, of some links."""
        return self.signal_dBm[links] - dBm_from_mW(interference_mW)


MAX_LN_HAZARD_TO_DECODE = math.log(0.7)  # half of the frames or more (MODEL 2)


def scene_of(plant: Plant, links: Sequence[int]) -> Scene:
    """Return the scene of a set of active links, in whatever order they come."""
    return Scene(plant, np.array(plant.in_order(links)))
