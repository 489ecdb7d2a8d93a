"""The incremental form for small networks: one Python number per active link.

Contenders and hidden power of a link are packed into one whole number, the count above bit
``COUNT_SHIFT``: a link that is switched adds one precomputed number to each active link, and
Python's whole numbers cannot overflow.
"""

from bisect import bisect_left
from collections.abc import Sequence

from ncsim_core.contracts.interference_model import Competition, InterferenceSession
from ncsim_core.network import LinkIndex
from typing_extensions import override

from ncsim_wifi.conflict import Relations
from ncsim_wifi.service import Levels, Shares

COUNT_SHIFT = 60
ONE_CONTENDER = 1 << COUNT_SHIFT
UNITS_MASK = ONE_CONTENDER - 1


def influence_rows(related: Relations, levels: Levels) -> list[list[int]]:
    """Return by (switched link, other link) what to add to the packed number of the other."""
    rows = []
    for link in range(related.link_count):
        row = [0] * related.link_count
        for other in related.conflicts.of(link).tolist():
            row[other] = ONE_CONTENDER
        at = related.victims.row(link)
        units = levels.victim_units[at].tolist()
        for other, power in zip(related.victims.links[at].tolist(), units, strict=True):
            row[other] = power
        rows.append(row)
    return rows


class RowSession(InterferenceSession):
    """Keeps the packed number and the factor of every active link.

    Args:
        influence: What ``influence_rows`` gives; shared by sessions, never changed.
        levels: Effective rates under hidden interference.
        shares: Factors by rates and number of stations.
        share_rows: Its rows by link and level.
    """

    def __init__(
        self,
        influence: list[list[int]],
        levels: Levels,
        shares: Shares,
        share_rows: list[list[list[float]]],
    ) -> None:
        self._influence = influence
        self._levels = levels
        self._shares = shares
        self._share_rows = share_rows
        self._packed: dict[LinkIndex, int] = {}
        self._factor: dict[LinkIndex, float] = {}

    @override
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        for link in off:
            del self._packed[link], self._factor[link]
        moved = self._moved([self._influence[i] for i in on], [self._influence[i] for i in off])
        self._welcome(on)
        moved += on
        links, factors = [], []
        for link in moved:
            factor = self._look_up(link)
            if factor != self._factor[link]:
                self._factor[link] = factor
                links.append(link)
                factors.append(factor)
        return links, factors

    def _moved(self, arriving: list[list[int]], leaving: list[list[int]]) -> list[LinkIndex]:
        """Bring the links that stay active up to date; return those whose number moved."""
        packed = self._packed
        moved = []
        for link, before in packed.items():
            now = before
            for row in arriving:
                now += row[link]
            for row in leaving:
                now -= row[link]
            if now != before:
                packed[link] = now
                moved.append(link)
        return moved

    def _welcome(self, on: Sequence[LinkIndex]) -> None:
        """Count what all active links do to those just switched on."""
        self._packed.update(dict.fromkeys(on, 0))
        self._factor.update(dict.fromkeys(on, 1.0))
        rows = [self._influence[link] for link in self._packed]
        for link in on:
            self._packed[link] = sum([row[link] for row in rows])

    def _look_up(self, link: LinkIndex) -> float:
        packed = self._packed[link]
        stations = (packed >> COUNT_SHIFT) + 1
        level = bisect_left(self._levels.limits[link], packed & UNITS_MASK)
        row = self._share_rows[link][level]
        if stations >= len(row):
            rates_Mbps = self._levels.rates_Mbps[link]
            self._shares.row(rates_Mbps[0], rates_Mbps[level], stations)
        return row[stations]

    @override
    def competition(self, links: Sequence[LinkIndex]) -> Sequence[Competition]:
        return [self._competition_of(link) for link in links]

    def _competition_of(self, link: LinkIndex) -> Competition:
        packed = self._packed[link]
        influences = [self._influence[other][link] for other in self._packed]
        return Competition(
            packed >> COUNT_SHIFT,
            sum([0 < influence < ONE_CONTENDER for influence in influences]),
            self._levels.hidden_factor(link, packed & UNITS_MASK),
        )
