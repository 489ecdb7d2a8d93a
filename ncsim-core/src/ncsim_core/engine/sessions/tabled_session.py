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


class TabledSession(InterferenceSession):
    """A session on tables.

    Args:
        loads: The tables, as numbers to add.
    """

    def __init__(self, loads: Loads) -> None:
        self._loads = loads
        self._active_mask = 0  # as of the last time that anybody asked
        self._toggled: list[LinkIndex] = []  # since then

    @abstractmethod
    def _loads_of(self, links: Sequence[LinkIndex]) -> list[int]:
        """Return the loads of active links."""

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
        count_shift, units_mask = loads.count_shift, loads.units_mask
        told = []
        for link, load in zip(links, self._loads_of(links), strict=True):
            contenders = load >> count_shift
            affecting = (active_mask & loads.affecting_mask(link)).bit_count()
            level = bisect_left(tables.limits[link], load & units_mask)
            hidden_factor = tables.hidden_factors[link][level]
            told.append(competition_of((contenders, affecting - contenders, hidden_factor)))
        return told
