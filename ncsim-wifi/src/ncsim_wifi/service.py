"""From contenders and hidden power to a factor: thresholds, levels and shares, tabulated.

Powers are summed as whole numbers of a *quantum* that belongs to each receiving link, so that
adding and taking away is exact whatever the order and the history. A comparison with a limit
on the sum takes the place of the logarithm in the SINR, and of each rate of the table.
"""

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np
from ncsim_core.network import LinkIndex

from ncsim_wifi.conflict import Relations
from ncsim_wifi.mac.efficiency import efficiency
from ncsim_wifi.mac.timing import Timing
from ncsim_wifi.phy.mcs import RateTable, rate_table
from ncsim_wifi.phy.received_power import tolerable_interference_mW
from ncsim_wifi.propagation import Propagation
from ncsim_wifi.quantities import FloatArray, IntArray, mW_from_dBm
from ncsim_wifi.radio import Radio

MAX_UNITS = 1 << 40  # of one interferer; 2**22 of them still fit into 64 bits


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
    served = effective_Mbps * efficiency(stations, effective_Mbps, timing)
    return served / (stations * clean_Mbps * efficiency(1, clean_Mbps, timing))


@dataclass(frozen=True)
class Levels:
    """Per link, what it can still do under how much hidden interference.

    A link is on the first level whose limit is not below its hidden sum, and in outage (the
    level after the last) when there is none. Level 0 is the clean rate, and the only one
    for the sum 0, which means that there is no hidden interferer.

    Args:
        limits: By link, the greatest hidden sum of each level, ascending, in its own quantum.
        rates_Mbps: By link, the effective rate of each level, descending, 0 at the end.
        victim_units: Power of each entry of ``Relations.victims`` in the victim's quantum.
    """

    limits: tuple[tuple[int, ...], ...]
    rates_Mbps: tuple[tuple[float, ...], ...]
    victim_units: IntArray

    def level(self, link: LinkIndex, hidden_units: int) -> int:
        """Return the level of a link under a hidden sum."""
        return bisect_left(self.limits[link], hidden_units)

    def effective_rate_Mbps(self, link: LinkIndex, hidden_units: int) -> float:
        """Return R_eff of a link under a hidden sum."""
        return self.rates_Mbps[link][self.level(link, hidden_units)]

    def hidden_factor(self, link: LinkIndex, hidden_units: int) -> float:
        """Return what hidden interferers leave of the clean rate; 1 for an unusable link."""
        clean_Mbps = self.rates_Mbps[link][0]
        if clean_Mbps <= 0.0:
            return 1.0
        return hidden_factor(self.effective_rate_Mbps(link, hidden_units), clean_Mbps)


def levels_of(signals: Propagation, related: Relations, radio: Radio) -> Levels:
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
    units = np.rint(related.victim_power_mW * units_per_mW[related.victims.links])
    return Levels(
        tuple(limit for limit, _ in by_link),
        tuple(rates for _, rates in by_link),
        np.clip(units, 1, MAX_UNITS).astype(np.int64),
    )


def _units_per_mW(signal_dBm: FloatArray, lowest_threshold_dB: float) -> FloatArray:
    """Return how many quanta of each link make a milliwatt.

    The most that any link can bear at all has fewer than ``MAX_UNITS`` quanta, so capping one
    interferer there changes nothing. The quantum depends on the link alone.
    """
    bearable_mW = mW_from_dBm(signal_dBm - lowest_threshold_dB)
    return np.divide(
        MAX_UNITS - 1, bearable_mW, out=np.ones_like(bearable_mW), where=bearable_mW > 0
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
    return np.floor(np.maximum(np.stack(columns, axis=1), 0.0)).astype(np.int64)


def _levels_of_link(
    clean_Mbps: float, limits: list[int], table: RateTable
) -> tuple[tuple[int, ...], tuple[float, ...]]:
    """Return limits and rates of one link, best first; rates above the clean one count as it."""
    limit_by_rate = {clean_Mbps: 0}
    for limit, rate_Mbps in zip(reversed(limits), reversed(table.rate_Mbps), strict=True):
        limit_by_rate[min(rate_Mbps, clean_Mbps)] = limit
    return tuple(limit_by_rate.values()), (*limit_by_rate, 0.0)


class Shares:
    """The factor of every clean rate, effective rate and number of stations that has come up.

    Args:
        timing: Frame timing.
        outage_floor_factor: The least factor that an active link is given.
    """

    def __init__(self, timing: Timing, outage_floor_factor: float = 0.0) -> None:
        self._timing = timing
        self._floor = outage_floor_factor
        self._rows: dict[tuple[float, float], list[float]] = {}

    def row(self, clean_Mbps: float, effective_Mbps: float, stations: int = 1) -> list[float]:
        """Return the factors by number of stations, up to ``stations`` at least.

        The list is the same whenever the rates are the same, and grows; index 0 has no meaning.
        """
        row = self._rows.setdefault((clean_Mbps, effective_Mbps), [0.0])
        while len(row) <= stations:
            row.append(self._factor(effective_Mbps, clean_Mbps, len(row)))
        return row

    def factor(self, clean_Mbps: float, effective_Mbps: float, stations: int) -> float:
        """Return the factor of one link, in [0, 1]."""
        return self.row(clean_Mbps, effective_Mbps, stations)[stations]

    def rows_by_level(self, levels: Levels) -> list[list[list[float]]]:
        """Return by link and level the row of factors."""
        return [[self.row(rates[0], rate) for rate in rates] for rates in levels.rates_Mbps]

    def _factor(self, effective_Mbps: float, clean_Mbps: float, stations: int) -> float:
        if clean_Mbps <= 0.0:  # unusable: nothing to slow down, but alone is alone
            return float(stations == 1 and effective_Mbps == clean_Mbps)
        factor = combined_factor(effective_Mbps, clean_Mbps, stations, self._timing)
        return max(factor, self._floor)
