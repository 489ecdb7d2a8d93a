"""Factors by rates and number of stations, tabulated as they come up."""

from functools import partial

from ncsim_core.contracts.interference_tables import ShareRow

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
        self._rows: dict[tuple[float, float], ShareRow] = {}

    def row(self, clean_Mbps: float, effective_Mbps: float) -> ShareRow:
        """Return the factors by number of stations, the same object whenever the rates are."""
        rates = clean_Mbps, effective_Mbps
        row = self._rows.get(rates)
        if row is None:
            is_outage = effective_Mbps <= 0.0 < clean_Mbps
            factor_of = partial(self._factor, effective_Mbps, clean_Mbps)
            row = self._rows[rates] = ShareRow(factor_of, is_constant=is_outage)
        return row

    def factor(self, clean_Mbps: float, effective_Mbps: float, stations: int) -> float:
        """Return the factor of one link, in [0, 1]."""
        return self.row(clean_Mbps, effective_Mbps).factor(stations)

    def rows_by_level(self, levels: Levels) -> list[list[ShareRow]]:
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
