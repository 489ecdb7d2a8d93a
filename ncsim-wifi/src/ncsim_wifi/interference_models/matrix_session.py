"""The incremental form for large networks: arrays over all links.

Each switched link adds its row of influences to the counts and sums of all links. A link's
level needs no new look-up while its hidden sum stays between the limits of that level, so
only links that changed level or number of contenders are looked at one by one.
"""

from collections.abc import Sequence

import numpy as np
from ncsim_core.contracts.interference_model import Competition, InterferenceSession
from ncsim_core.network import LinkIndex
from typing_extensions import override

from ncsim_wifi.conflict import Relations
from ncsim_wifi.service import Levels, Shares

NOT_SEEN = -1
NO_LIMIT = np.iinfo(np.int64).max


class MatrixSession(InterferenceSession):
    """Keeps contenders, hidden sum, level bounds and factor of every link.

    Args:
        related: Conflict graph and hidden interference.
        levels: Effective rates under hidden interference.
        shares: Factors by rates and number of stations.
        share_rows: Its rows by link and level.
    """

    def __init__(
        self,
        related: Relations,
        levels: Levels,
        shares: Shares,
        share_rows: list[list[list[float]]],
    ) -> None:
        self._related = related
        self._levels = levels
        self._shares = shares
        self._share_rows = share_rows
        count = related.link_count
        self._is_active = np.zeros(count, np.bool_)
        self._contenders = np.zeros(count, np.int64)
        self._hidden_units = np.zeros(count, np.int64)
        self._seen_contenders = np.full(count, NOT_SEEN)
        self._above = np.full(count, -1)
        self._up_to = np.zeros(count, np.int64)
        self._factor = [1.0] * count

    @override
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        for link in off:
            self._switch(link, -1)
        for link in on:
            self._switch(link, 1)
        links, factors = [], []
        for link in self._moved():
            factor = self._look_up(link)
            if factor != self._factor[link]:
                self._factor[link] = factor
                links.append(link)
                factors.append(factor)
        return links, factors

    def _switch(self, link: LinkIndex, step: int) -> None:
        self._is_active[link] = step > 0
        self._seen_contenders[link] = NOT_SEEN
        self._factor[link] = 1.0
        self._contenders[self._related.conflicts.of(link)] += step
        row = self._related.victims.row(link)
        self._hidden_units[self._related.victims.links[row]] += (
            step * self._levels.victim_units[row]
        )

    def _moved(self) -> list[LinkIndex]:
        """Return the active links that changed level or contenders since they were looked at."""
        has_moved = self._contenders != self._seen_contenders
        has_moved |= self._hidden_units > self._up_to
        has_moved |= self._hidden_units <= self._above
        has_moved &= self._is_active
        moved: list[LinkIndex] = np.flatnonzero(has_moved).tolist()
        return moved

    def _look_up(self, link: LinkIndex) -> float:
        """Return the factor of a link and note between which limits its level holds."""
        contenders = int(self._contenders[link])
        limits = self._levels.limits[link]
        level = self._levels.level(link, int(self._hidden_units[link]))
        self._seen_contenders[link] = contenders
        self._above[link] = limits[level - 1] if level else -1
        self._up_to[link] = limits[level] if level < len(limits) else NO_LIMIT
        row = self._share_rows[link][level]
        if contenders + 1 >= len(row):
            rates_Mbps = self._levels.rates_Mbps[link]
            self._shares.row(rates_Mbps[0], rates_Mbps[level], contenders + 1)
        return row[contenders + 1]

    @override
    def competition(self, links: Sequence[LinkIndex]) -> Sequence[Competition]:
        return [self._competition_of(link) for link in links]

    def _competition_of(self, link: LinkIndex) -> Competition:
        return Competition(
            int(self._contenders[link]),
            int(np.count_nonzero(self._is_active[self._related.interferers.of(link)])),
            self._levels.hidden_factor(link, int(self._hidden_units[link])),
        )
