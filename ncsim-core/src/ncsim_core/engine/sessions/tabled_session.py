"""What the sessions on tables have in common: which links are active, and who explains them."""

from abc import abstractmethod
from bisect import bisect_left
from collections.abc import Sequence
from typing import Final

from typing_extensions import override

from ncsim_core.contracts.interference_model import (
    Competition,
    InterferenceSession,
    competition_of,
)
from ncsim_core.engine.sessions.loads import Loads
from ncsim_core.network import LinkIndex

MAX_TOGGLED: Final = 10_000
MAX_KNOWN: Final = 10_000


class TabledSession(InterferenceSession):
    """A session on tables.

    Args:
        loads: The tables, as numbers to add.
    """

    def __init__(self, loads: Loads) -> None:
        self._loads = loads
        self._active_mask = 0  # as of the last time that anybody asked
        self._toggled: list[LinkIndex] = []  # since then
        self._known: dict[tuple[LinkIndex, int], Competition] = {}  # by link and active ones about

    @abstractmethod
    def _load_of(self, link: LinkIndex) -> int:
        """Return the load of an active link."""

    def _toggle(self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]) -> None:
        """Note which links are switched, for the case that somebody asks about competition."""
        self._toggled += on
        self._toggled += off
        if len(self._toggled) > MAX_TOGGLED:
            self._bring_mask_up_to_date()

    def _bring_mask_up_to_date(self) -> None:
        mask = self._active_mask
        for link in self._toggled:
            mask ^= 1 << link
        self._active_mask = mask
        self._toggled.clear()

    @override
    def competition(self, links: Sequence[LinkIndex]) -> Sequence[Competition]:
        self._bring_mask_up_to_date()
        loads, tables, active_mask = self._loads, self._loads.tables, self._active_mask
        count_shift, units_mask, known = loads.count_shift, loads.units_mask, self._known
        told = []
        for link in links:
            affecting = active_mask & loads.affecting_mask(link)
            competition = known.get((link, affecting))  # what it is up against follows from these
            if competition is None:
                load = self._load_of(link)
                contenders, hidden_units = load >> count_shift, load & units_mask
                level = bisect_left(tables.limits[link], hidden_units)
                hidden = affecting.bit_count() - contenders
                competition = competition_of(
                    (contenders, hidden, tables.hidden_factors[link][level])
                )
                if len(known) < MAX_KNOWN:
                    known[link, affecting] = competition
            told.append(competition)
        return told
