"""The session of a model that decides routes: only which links are in use."""

from collections.abc import Sequence

from typing_extensions import override

from ncsim_core.contracts.interference_model import (
    Competition,
    InterferenceModel,
    InterferenceSession,
)
from ncsim_core.network import LinkIndex


class LinksInUse(InterferenceSession):
    """Knows what links are up against and never asks for a factor.

    Args:
        model: The model that explains competition.
    """

    def __init__(self, model: InterferenceModel) -> None:
        self._model = model
        self._active: dict[LinkIndex, None] = {}

    @override
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        for link in off:
            del self._active[link]
        self._active.update(dict.fromkeys(on))
        return (), ()

    @override
    def competition(self, links: Sequence[LinkIndex]) -> Sequence[Competition]:
        return self._model.competition(links, self._active.keys())
