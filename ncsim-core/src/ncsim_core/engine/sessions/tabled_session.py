"""What the sessions on tables have in common: which links are active, and who explains them."""

from abc import abstractmethod
from bisect import bisect_left
from collections.abc import Sequence
from typing import Final

from typing_extensions import override

from ncsim_core.contracts.interference_model import Against, Competition, InterferenceSession
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
        return list(map(Competition._make, zip(*self.against(links), strict=True)))

    def against(self, links: Sequence[LinkIndex]) -> Against:
        """Return what each of ``links`` is up against now, as columns."""
        self._bring_mask_up_to_date()
        active_mask, mask_of = self._active_mask, self._loads.affecting_mask
        count_shift, units_mask = self._loads.count_shift, self._loads.units_mask
        limits, factor_of = self._loads.tables.limits, self._loads.tables.hidden_factors
        contenders, hidden, factors = [], [], []
        for link, load in zip(links, self._loads_of(links), strict=True):
            conflicting = load >> count_shift
            contenders.append(conflicting)
            hidden.append((active_mask & mask_of(link)).bit_count() - conflicting)
            factors.append(factor_of[link][bisect_left(limits[link], load & units_mask)])
        return contenders, hidden, factors
