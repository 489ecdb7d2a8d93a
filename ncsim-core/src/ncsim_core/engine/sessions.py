"""Which session of the interference model a run works with."""

from collections.abc import Sequence

from typing_extensions import override

from ncsim_core.contracts.interference_model import (
    Competition,
    InterferenceModel,
    InterferenceSession,
    PlainSession,
    Unaffected,
)
from ncsim_core.engine.boundary import CheckedSession, asked
from ncsim_core.engine.setup import Setup
from ncsim_core.network import LinkIndex


def session_of(setup: Setup) -> InterferenceSession | None:
    """Return a fresh session for one run, ``None`` if no link ever affects another."""
    model = setup.models.interference
    who = setup.models.identity("interference_model")
    if model.decides_routes:
        return CheckedSession(LinksInUse(model), who)
    if setup.is_global:
        return CheckedSession(PlainSession(model, is_global=True), who)
    session = asked(who, model.open_session)
    return None if isinstance(session, Unaffected) else CheckedSession(session, who)


class LinksInUse(InterferenceSession):
    """The session of a model that decides routes: only which links are in use.

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
