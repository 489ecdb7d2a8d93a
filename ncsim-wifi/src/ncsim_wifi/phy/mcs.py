"""Rate tables: which PHY rate a signal-to-noise ratio allows."""

import csv
import difflib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from itertools import pairwise

import numpy as np
from ncsim_core.errors import ScenarioError

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.radio import Radio

TABLES = files("ncsim_wifi") / "tables"


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
                raise ScenarioError(f"a rate table must increase strictly, not {column!r}")

    def scaled(self, factor: float) -> "RateTable":
        """Return the table of a channel ``factor`` times as wide (SPEC 2)."""
        return RateTable(self.snr_min_dB, tuple(rate * factor for rate in self.rate_Mbps))

    def index_for(self, snr_dB: float) -> int:
        """Return the index of the highest scheme whose threshold is met, -1 if none is."""
        return int(np.searchsorted(self.snr_min_dB, snr_dB, side="right")) - 1


def table_names() -> list[str]:
    """Return the names of all rate tables: one CSV file each, and nothing else to do."""
    return sorted(
        entry.name.removesuffix(".csv") for entry in TABLES.iterdir() if entry.name.endswith(".csv")
    )


@cache
def read_table(standard: str) -> RateTable:
    """Return the 20 MHz table of a standard.

    Source: Table ``tab:mcs_parameters`` (ax); SPEC 2 (n, ac).

    Raises:
        ScenarioError: There is no such table.
    """
    names = table_names()
    if standard not in names:
        near = difflib.get_close_matches(standard, names, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise ScenarioError(
            f"rf.wifi_standard: no rate table {standard!r}; there are {', '.join(names)}{hint}"
        )
    return parse_table((TABLES / f"{standard}.csv").read_text("utf-8").splitlines())


def parse_table(lines: Iterable[str]) -> RateTable:
    """Return the table of CSV lines with the columns ``mcs,snr_min_dB,rate_Mbps``."""
    rows = list(csv.DictReader(lines))
    return RateTable(
        tuple(float(row["snr_min_dB"]) for row in rows),
        tuple(float(row["rate_Mbps"]) for row in rows),
    )


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
