"""How much does concurrent traffic slow a link?

A model may be written in one of three forms, of which each goes with less calls into the model than
the one before; the conformance kit proves equal those that a model has.

* Plain, the easiest: ``factors`` and ``reach``, pure functions of their arguments.
* Incremental: ``open_session`` returns an object that the engine owns for one run and tells
  which links were switched on and off.
* Declarative: ``tables`` gives the model as data, and the engine's own kernels do the rest, with
  ``factors`` for those who ask about links alone.

In all, a transfer gets the least share on its route, each link shared equally. A model that knows
better what a whole route carries, because relays forward only what they receive, sets
``decides_routes`` and answers ``route_rates`` instead.
"""

from abc import ABC, abstractmethod
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, ClassVar, Final, NamedTuple, TypeAlias

from typing_extensions import override

from ncsim_core.contracts.interference_tables import InterferenceTables
from ncsim_core.network import LinkIndex, Route

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Competition(NamedTuple):
    """What one active link is up against, for the trace and for explanations.

    Args:
        contenders: Other active links inside its conflict neighbourhood.
        hidden_interferers: Active links outside it whose power reaches the receiver.
        hidden_factor: The part of ``factor`` that hidden interferers alone explain, in [0, 1].
    """

    contenders: int = 0
    hidden_interferers: int = 0
    hidden_factor: float = 1.0


NO_COMPETITION: Final = Competition()

Against: TypeAlias = tuple[Sequence[int], Sequence[int], Sequence[float]]
"""The fields of ``Competition`` of several links, as columns."""


class RouteRates(NamedTuple):
    """What transfers get on their routes.

    Args:
        rates_MBps: Rate of each route, shape ``(routes,)``; 0 pauses a transfer.
        bottlenecks: For each route, the link on it that decides.
    """

    rates_MBps: "NDArray[np.float64]"
    bottlenecks: Sequence[LinkIndex]


class InterferenceModel(ABC):
    """Gives each active link a factor in [0, 1] that multiplies its clean bandwidth.

    Attributes:
        decides_routes: Whether the engine asks for the rates of whole routes instead.
    """

    decides_routes: ClassVar[bool] = False

    @abstractmethod
    def factors(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> "NDArray[np.float64]":
        """Return the factor of each of ``links``, shape ``(len(links),)``.

        ``active`` holds every link used by an unfinished transfer and contains ``links``. The
        answer depends on the set only, not on its order; a link that is alone has factor 1.

        Raises:
            ModelScopeError: The model does not cover this set of links.
        """

    @abstractmethod
    def reach(self, changed: Collection[LinkIndex]) -> Collection[LinkIndex]:
        """Return all links whose factor may move when ``changed`` switch on or off.

        The engine asks again only for these, so leaving one out makes results wrong; naming
        too many only costs time. The changed links themselves belong to the answer.
        """

    def route_rates(self, routes: Sequence[Route]) -> RouteRates:
        """Return what the transfers on ``routes``, all that are under way, get now.

        Asked at every start and finish of a transfer, and only if ``decides_routes``. The answer
        depends on the routes alone and not on the order in which they are listed, rounding
        apart; the engine always sorts them, so that equal routes give equal answers to the last
        bit. A route that occurs twice stands for two transfers, which get the same.

        No rate is above the least clean bandwidth of its route, and no link carries more than
        its clean bandwidth; a route of one link that is alone gets just that.

        Args:
            routes: Routes of one link or more, ascending as tuples.

        Raises:
            ModelScopeError: The model does not cover these routes.
        """
        raise NotImplementedError(f"{type(self).__name__} has no route_rates()")

    def competition(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> Sequence[Competition]:
        """Return what each of ``links`` is up against; by default, nothing is known."""
        del active
        return [NO_COMPETITION] * len(links)

    def open_session(self) -> "InterferenceSession":
        """Return a fresh session for one run; not asked of a model that has ``tables``."""
        return PlainSession(self)

    def tables(self) -> InterferenceTables | None:
        """Return the model as data, the same object each time, or ``None`` if it is none."""
        return None


class InterferenceSession(ABC):
    """The active links of one run and their factors, kept up to date step by step."""

    @abstractmethod
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        """Switch links on and off; return the active links whose factor changed, and to what.

        A link that was just switched on counts as having had factor 1. ``on`` and ``off`` share
        no link, and hold no link that is already in that state.
        """

    @abstractmethod
    def competition(self, links: Sequence[LinkIndex]) -> Sequence[Competition]:
        """Return what each of ``links`` is up against now."""


class PlainSession(InterferenceSession):
    """A session over a model in plain form.

    Args:
        model: The model to ask.
        is_global: Ask for every active link after every change instead of those in
            reach. This is the slow oracle that local refresh is tested against.
    """

    def __init__(self, model: InterferenceModel, *, is_global: bool = False) -> None:
        self._model = model
        self._is_global = is_global
        self._factor_by_link: dict[LinkIndex, float] = {}

    @override
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        for link in off:
            del self._factor_by_link[link]
        for link in on:
            self._factor_by_link[link] = 1.0
        links = self._links_to_ask([*on, *off])
        if not links:
            return (), ()
        factors = _listed(self._model.factors(links, self._factor_by_link.keys()), len(links))
        changed = [
            (link, factor)
            for link, factor in zip(links, factors, strict=True)
            if factor != self._factor_by_link[link]
        ]
        self._factor_by_link.update(changed)
        return [link for link, _ in changed], [factor for _, factor in changed]

    @override
    def competition(self, links: Sequence[LinkIndex]) -> Sequence[Competition]:
        return self._model.competition(links, self._factor_by_link.keys())

    def _links_to_ask(self, switched: Sequence[LinkIndex]) -> list[LinkIndex]:
        if self._is_global:
            return sorted(self._factor_by_link)
        answer: object = self._model.reach(switched)
        if not isinstance(answer, Collection):
            raise TypeError(f"reach() gave {answer!r}, not a collection of links")
        reached = set(answer)
        if not reached.issuperset(switched):
            left_out = sorted(set(switched) - reached)
            raise ValueError(f"reach() leaves out the changed links {left_out}")
        return sorted(self._factor_by_link.keys() & reached)


def _listed(factors: "NDArray[np.float64]", count: int) -> list[float]:
    """Return factors as a list.

    Raises:
        TypeError: They are no array, or not as many as links were asked about.
    """
    shape = getattr(factors, "shape", type(factors).__name__)
    if shape != (count,):
        raise TypeError(f"factors() gave {shape}, not an array of shape ({count},)")
    listed: list[float] = factors.tolist()
    return listed


class Unaffected(InterferenceSession):
    """The session of a model under which no link ever affects another; the engine skips it."""

    @override
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        return (), ()

    @override
    def competition(self, links: Sequence[LinkIndex]) -> Sequence[Competition]:
        return [NO_COMPETITION] * len(links)
