"""Contention after Bianchi, and hidden interference as a lower effective rate: plain form."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from ncsim_core.contracts.interference_model import Competition, InterferenceModel
from ncsim_core.contracts.interference_tables import InterferenceTables
from ncsim_core.network import LinkIndex
from typing_extensions import override

from ncsim_wifi.conflict import Relations
from ncsim_wifi.levels import Levels
from ncsim_wifi.quantities import FloatArray, IntArray
from ncsim_wifi.shares import Shares

ENTRIES_PER_BLOCK = 1 << 20  # so that no second array of all entries is needed


@dataclass(frozen=True)
class Tally:
    """What a set of active links does to every link, in link order.

    Args:
        contenders: Active links in the conflict neighbourhood.
        interferers: Active hidden interferers.
        hidden_units: Their power at the receiver, in its quantum.
    """

    contenders: IntArray
    interferers: IntArray
    hidden_units: IntArray


def tally(active: Collection[LinkIndex], related: Relations, levels: Levels) -> Tally:
    """Return what a set of active links does to every link; whole numbers, so in any order.

    Source: Section IV-F (``sec:bianchi``), C and H of each link.
    """
    counts = Tally(*(np.zeros(related.link_count, np.int64) for _ in range(3)))
    for link in active:
        victims, powers_mW = related.hidden(link)
        counts.contenders[related.conflicts(link)] += 1
        counts.interferers[victims] += 1
        counts.hidden_units[victims] += levels.units(victims, powers_mW)
    return counts


def hidden_units(related: Relations, levels: Levels) -> IntArray:
    """Return the power of each entry at the affected receiver in its quantum, 0 for conflicts."""
    units = np.zeros(len(related.links), np.int64)
    done = 0
    for start in range(0, len(units), ENTRIES_PER_BLOCK):
        block = slice(start, start + ENTRIES_PER_BLOCK)
        hidden = np.flatnonzero(~related.is_conflict[block]) + start
        powers_mW = related.hidden_mW[done : done + len(hidden)]
        units[hidden] = levels.units(related.links[hidden], powers_mW)
        done += len(hidden)
    return units


class EffectiveRateModel(InterferenceModel):
    """Scales a link by R_eff eta(n, R_eff) / (n R eta(1, R)).

    Source: Eq. 12 (``eq:combined``); SPEC 4 and 5.

    Args:
        related: Conflict graph and hidden interference.
        levels: Effective rates under hidden interference.
        shares: Factors by rates and number of stations.
    """

    def __init__(self, related: Relations, levels: Levels, shares: Shares) -> None:
        self._related = related
        self._levels = levels
        self._shares = shares

    @override
    def factors(self, links: Sequence[LinkIndex], active: Collection[LinkIndex]) -> FloatArray:
        counts = tally(active, self._related, self._levels)
        stations, hidden_units = counts.contenders + 1, counts.hidden_units
        return np.array(
            [self._factor(link, int(stations[link]), int(hidden_units[link])) for link in links],
            dtype=np.float64,
        )

    def _factor(self, link: LinkIndex, stations: int, hidden_units: int) -> float:
        clean_Mbps = self._levels.rates_Mbps[link][0]
        effective_Mbps = self._levels.effective_rate_Mbps(link, hidden_units)
        return self._shares.factor(clean_Mbps, effective_Mbps, stations)

    @override
    def reach(self, changed: Collection[LinkIndex]) -> Collection[LinkIndex]:
        return self._related.reach(changed)

    @override
    def competition(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> Sequence[Competition]:
        counts = tally(active, self._related, self._levels)
        return [
            Competition(
                int(counts.contenders[link]),
                int(counts.interferers[link]),
                self._levels.hidden_factor(link, int(counts.hidden_units[link])),
            )
            for link in links
        ]

    @override
    def tables(self) -> InterferenceTables:
        return self._tables

    @cached_property
    def _tables(self) -> InterferenceTables:
        related, levels = self._related, self._levels
        return InterferenceTables(
            starts=related.starts,
            links=related.links,
            is_conflict=related.is_conflict,
            hidden_units=hidden_units(related, levels),
            limits=levels.limits,
            shares=self._shares.rows_by_level(levels),
            hidden_factors=levels.hidden_factors,
        )
