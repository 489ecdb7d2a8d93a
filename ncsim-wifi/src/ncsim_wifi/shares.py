"""Factors by rates and number of stations, tabulated as they come up."""

from ncsim_wifi.levels import Levels
from ncsim_wifi.mac.timing import Timing
from ncsim_wifi.service import combined_factor


class Shares:
    """The factor of every clean rate, effective rate and number of stations that has come up.

    Args:
        timing: Frame timing.
        outage_floor_factor: The least factor that an active link is given.
    """

    def __init__(self, timing: Timing, outage_floor_factor: float = 0.0) -> None:
        self._timing = timing
        self.floor = outage_floor_factor
        self._rows: dict[tuple[float, float], list[float]] = {}

    def row(self, clean_Mbps: float, effective_Mbps: float) -> list[float]:
        """Return the factors by number of stations that have come up; index 0 has no meaning.

        The list is the same whenever the rates are the same, and grows.
        """
        return self._rows.setdefault((clean_Mbps, effective_Mbps), [0.0])

    def grow(
        self, row: list[float], clean_Mbps: float, effective_Mbps: float, stations: int
    ) -> None:
        """Add factors to a row, up to ``stations``."""
        while len(row) <= stations:
            row.append(self._factor(effective_Mbps, clean_Mbps, len(row)))

    def factor(self, clean_Mbps: float, effective_Mbps: float, stations: int) -> float:
        """Return the factor of one link, in [0, 1]."""
        row = self.row(clean_Mbps, effective_Mbps)
        self.grow(row, clean_Mbps, effective_Mbps, stations)
        return row[stations]

    def rows_by_level(self, levels: Levels) -> list[list[list[float]]]:
        """Return by link and level the row of factors."""
        rows = {
            rates: [self.row(rates[0], rate) for rate in rates] for rates in set(levels.rates_Mbps)
        }
        return [rows[rates] for rates in levels.rates_Mbps]

    def _factor(self, effective_Mbps: float, clean_Mbps: float, stations: int) -> float:
        if clean_Mbps <= 0.0:  # unusable: nothing to slow down, but alone is alone
            return float(stations == 1 and effective_Mbps == clean_Mbps)
        factor = combined_factor(effective_Mbps, clean_Mbps, stations, self._timing)
        return max(factor, self.floor)
