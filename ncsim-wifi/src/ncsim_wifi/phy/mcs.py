"""Rate tables: which PHY rate a signal-to-noise ratio allows."""

import csv
import difflib
import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
from ncsim_core.errors import ScenarioError

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.radio import Radio
from ncsim_wifi.tables import table_file, table_names

COLUMNS = ["mcs", "snr_min_dB", "rate_Mbps"]


@dataclass(frozen=True)
class RateTable:
    """Modulation and coding schemes in order of rate.

    Args:
        snr_min_dB: The ratio from which each may be used, strictly increasing.
        rate_Mbps: Its PHY rate, strictly increasing.
    """

    snr_min_dB: tuple[float, ...]
    rate_Mbps: tuple[float, ...]

    def __post_init__(self) -> None:
        for column in (self.snr_min_dB, self.rate_Mbps):
            if not column or any(b <= a for a, b in pairwise(column)):
                raise ScenarioError(f"rates and thresholds must increase strictly, not {column!r}")

    def scaled(self, factor: float) -> "RateTable":
        """Return the table of a channel ``factor`` times as wide (SPEC 2)."""
        return RateTable(self.snr_min_dB, tuple(rate * factor for rate in self.rate_Mbps))

    def index_for(self, snr_dB: float) -> int:
        """Return the index of the highest scheme whose threshold is met, -1 if none is."""
        return int(np.searchsorted(self.snr_min_dB, snr_dB, side="right")) - 1


@cache
def read_table(standard: str) -> RateTable:
    """Return the 20 MHz table of a standard.

    Source: Table ``tab:mcs_parameters`` (ax); SPEC 2 (n, ac).

    Raises:
        ScenarioError: There is no such table, or it is no table.
    """
    names = table_names()
    if standard not in names:
        near = difflib.get_close_matches(standard, names, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise ScenarioError(
            f"rf.wifi_standard: no rate table {standard!r}; there are {', '.join(names)}{hint}"
        )
    file = table_file(standard)
    return parse_table(file.read_text("utf-8").splitlines(), str(file))


def parse_table(lines: Iterable[str], name: str = "rate table") -> RateTable:
    """Return the table of CSV lines that begin with ``mcs,snr_min_dB,rate_Mbps``.

    Args:
        lines: One scheme each; empty ones count for nothing.
        name: What messages call the table.

    Raises:
        ScenarioError: The columns are others, a number is none, or rates do not increase.
    """
    reader = csv.reader(lines, skipinitialspace=True)
    header = next(reader, [])
    if [cell.strip() for cell in header] != COLUMNS:
        raise ScenarioError(f"{name}:1  must begin with {','.join(COLUMNS)}, not {header!r}")
    rows = [_numbers(cells, f"{name}:{reader.line_num}") for cells in reader if cells]
    try:
        return RateTable(tuple(snr_dB for snr_dB, _ in rows), tuple(rate for _, rate in rows))
    except ScenarioError as error:
        raise ScenarioError(f"{name}  {error}") from None


def _numbers(cells: list[str], where: str) -> tuple[float, float]:
    """Return threshold and rate of one line."""
    try:
        _, snr_dB, rate_Mbps = map(float, cells)
    except ValueError:
        raise ScenarioError(f"{where}  must be three numbers, not {', '.join(cells)!r}") from None
    if not (math.isfinite(snr_dB) and 0.0 < rate_Mbps < math.inf):
        raise ScenarioError(f"{where}  needs a finite threshold and a rate above 0, not {cells!r}")
    return snr_dB, rate_Mbps


def rate_table(radio: Radio) -> RateTable:
    """Return the rate table of a radio at its channel width."""
    return read_table(radio.wifi_standard).scaled(radio.rate_scale)


def phy_rate_Mbps(snr_dB: FloatArray, table: RateTable) -> FloatArray:
    """Return the highest rate whose threshold is met, 0 where none is.

    Source: Eq. 4 (``eq:mcs``).

    >>> phy_rate_Mbps(np.array([4.19, 24.27]), read_table("ax")).tolist()
    [0.0, 68.8]
    """
    rates_Mbps = np.array([0.0, *table.rate_Mbps])
    return rates_Mbps[np.searchsorted(table.snr_min_dB, snr_dB, side="right")]
