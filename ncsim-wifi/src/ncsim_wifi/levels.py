"""How much hidden interference a link bears at which rate.

Powers are summed as whole numbers of a *quantum* that belongs to each receiving link, so that
adding and taking away is exact whatever the order and the history. A comparison with a limit
on the sum takes the place of the logarithm in the SINR, and of each rate of the table.
"""

from bisect import bisect_left
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from ncsim_core.network import LinkIndex

from ncsim_wifi.conflict import LinkArray
from ncsim_wifi.phy.mcs import RateTable, rate_table
from ncsim_wifi.phy.received_power import tolerable_interference_mW
from ncsim_wifi.propagation import Propagation
from ncsim_wifi.quantities import FloatArray, IntArray, mW_from_dBm
from ncsim_wifi.radio import Radio
from ncsim_wifi.service import hidden_factor, shifted_thresholds_dB

UNIT_BITS = 36
MAX_UNITS = 1 << UNIT_BITS  # of one interferer: at the highest threshold a step of 3e-7 dB


@dataclass(frozen=True)
class Levels:
    """Per link, what it can still do under how much hidden interference.

    A link is on the first level whose limit is not below its hidden sum, and in outage (the
    level after the last) when there is none. Level 0 is the clean rate, and the only one
    for the sum 0, which means that there is no hidden interferer.

    Args:
        limits: By link, the greatest hidden sum of each level, ascending, in its own quantum.
        rates_Mbps: By link, the effective rate of each level, descending, 0 at the end.
        units_per_mW: By link, how many quanta make a milliwatt.
    """

    limits: tuple[tuple[int, ...], ...]
    rates_Mbps: tuple[tuple[float, ...], ...]
    units_per_mW: FloatArray

    def units(self, links: LinkArray, power_mW: FloatArray) -> IntArray:
        """Return powers at the receivers of ``links`` in their quanta, 1 at least."""
        units = power_mW * self.units_per_mW[links]
        np.rint(units, out=units)
        np.clip(units, 1, MAX_UNITS, out=units)
        return units.astype(np.int64)

    def level(self, link: LinkIndex, hidden_units: int) -> int:
        """Return the level of a link under a hidden sum."""
        return bisect_left(self.limits[link], hidden_units)

    def effective_rate_Mbps(self, link: LinkIndex, hidden_units: int) -> float:
        """Return R_eff of a link under a hidden sum."""
        return self.rates_Mbps[link][self.level(link, hidden_units)]

    def hidden_factor(self, link: LinkIndex, hidden_units: int) -> float:
        """Return what hidden interferers leave of the clean rate; 1 for an unusable link."""
        return self.hidden_factors[link][self.level(link, hidden_units)]

    @cached_property
    def hidden_factors(self) -> tuple[tuple[float, ...], ...]:
        """Return by link and level what hidden interferers leave of the clean rate."""
        by_rates = {rates: _hidden_factors(rates) for rates in set(self.rates_Mbps)}
        return tuple(by_rates[rates] for rates in self.rates_Mbps)


def _hidden_factors(rates_Mbps: tuple[float, ...]) -> tuple[float, ...]:
    clean_Mbps = rates_Mbps[0]
    if clean_Mbps <= 0.0:
        return (1.0,) * len(rates_Mbps)
    return tuple(hidden_factor(rate_Mbps, clean_Mbps) for rate_Mbps in rates_Mbps)


def levels_of(signals: Propagation, radio: Radio) -> Levels:
    """Return the levels of every link of a network.

    Source: Eqs. 9 and 10 (``eq:sinr``, ``eq:capture``) and R_eff above Eq. 11; SPEC 5.
    """
    table = rate_table(radio)
    thresholds_dB = shifted_thresholds_dB(table, radio.capture_margin_dB)
    units_per_mW = _units_per_mW(signals.signal_dBm, thresholds_dB[0])
    limits = _limits(signals.signal_dBm, units_per_mW, thresholds_dB, radio)
    by_link = [
        _levels_of_link(clean_Mbps, row, table)
        for clean_Mbps, row in zip(signals.rate_Mbps.tolist(), limits.tolist(), strict=True)
    ]
    return Levels(
        tuple(limits for limits, _ in by_link), tuple(rates for _, rates in by_link), units_per_mW
    )


def _units_per_mW(signal_dBm: FloatArray, lowest_threshold_dB: float) -> FloatArray:
    """Return how many quanta of each link make a milliwatt.

    The most that any link can bear at all has fewer than ``MAX_UNITS`` quanta, so capping one
    interferer there changes nothing. The quantum depends on the link alone.
    """
    bearable_mW = mW_from_dBm(signal_dBm - lowest_threshold_dB)
    return np.divide(
        float(MAX_UNITS - 1), bearable_mW, out=np.ones_like(bearable_mW), where=bearable_mW > 0
    )


def _limits(
    signal_dBm: FloatArray,
    units_per_mW: FloatArray,
    thresholds_dB: tuple[float, ...],
    radio: Radio,
) -> IntArray:
    """Return the limit of each link (row) at each rate of the table (column), 0 or more."""
    columns = [
        tolerable_interference_mW(signal_dBm, radio.noise_floor_dBm, threshold_dB) * units_per_mW
        for threshold_dB in thresholds_dB
    ]
    return np.rint(np.maximum(np.stack(columns, axis=1), 0.0)).astype(np.int64)


def _levels_of_link(
    clean_Mbps: float, limits: list[int], table: RateTable
) -> tuple[tuple[int, ...], tuple[float, ...]]:
    """Return limits and rates of one link, best first; rates above the clean one count as it."""
    limit_by_rate = {clean_Mbps: 0}
    for limit, rate_Mbps in zip(reversed(limits), reversed(table.rate_Mbps), strict=True):
        limit_by_rate[min(rate_Mbps, clean_Mbps)] = limit
    return tuple(limit_by_rate.values()), (*limit_by_rate, 0.0)
