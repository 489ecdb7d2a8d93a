"""An interference model as data: what the engine's own kernels need to do without the model.

The form covers carrier sensing with hidden interference: the factor of a link depends on how many
links of its conflict set are active, and on the level that the sum of the powers of the
other active links that reach it leaves it. Powers are whole numbers, so that sums are exact
whatever their order and history.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

from typing_extensions import override

from ncsim_core.errors import PluginError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

FactorOf: TypeAlias = Callable[[int], float]
"""Gives a factor in [0, 1] to a number of stations, the link itself among them."""


class ShareRow:
    """The factors of links on one level by number of stations, worked out when they come up.

    Args:
        factor_of: Works one out.
        is_constant: Whether it always gives the same, as in an outage.
    """

    __slots__ = ("_factor_of", "factors", "is_constant")

    def __init__(self, factor_of: FactorOf, *, is_constant: bool = False) -> None:
        self._factor_of = factor_of
        self.is_constant = is_constant
        self.factors = [1.0]  # without any station; has no meaning

    def factor(self, stations: int) -> float:
        """Return the factor with this many stations.

        Raises:
            PluginError: It is no number in [0, 1].
        """
        factors = self.factors
        while len(factors) <= stations:
            factor = float(self._factor_of(len(factors)))
            if not (math.isfinite(factor) and 0.0 <= factor <= 1.0):
                raise PluginError(f"the interference table has the factor {factor!r}")
            factors.append(factor)
        return factors[stations]


@dataclass(frozen=True, eq=False)
class InterferenceTables:
    """Which links affect which, and what that does to them.

    Row ``i`` holds the links that are affected when link ``i`` is active:
    ``links[starts[i]:starts[i + 1]]``, each once, and so on for the other arrays.

    A link is on the first level whose limit is not below its hidden sum, and on the level after
    the last when there is none.

    Args:
        starts: Where rows begin, shape ``(links + 1,)``.
        links: The affected links.
        is_conflict: Whether they are in the conflict set, or hear the power unheard by it.
        hidden_units: Received power as a whole number of a quantum that belongs to the affected
            link, 1 or more; what stands at conflicts is not looked at.
        limits: By link, the greatest hidden sum of each level, ascending, 0 or more.
        shares: By link and level, the factors by number of stations, that is by one more than
            the active links of the conflict set. Level 0 with one station has factor 1.
        hidden_factors: By link and level, what hidden interference alone explains, in [0, 1].
        kept: What the engine has worked out from them, by name; goes when they go.
    """

    starts: "NDArray[np.int64]"
    links: "NDArray[np.int32]"
    is_conflict: "NDArray[np.bool_]"
    hidden_units: "NDArray[np.int64]"
    limits: Sequence[tuple[int, ...]]
    shares: Sequence[Sequence[ShareRow]]
    hidden_factors: Sequence[Sequence[float]]
    kept: dict[str, object] = field(default_factory=dict, init=False, repr=False)

    @override
    def __getstate__(self) -> dict[str, object]:
        return {**vars(self), "kept": {}}

    @property
    def link_count(self) -> int:
        """Return the number of links, those that nothing affects included."""
        return len(self.starts) - 1

    def fault(self, link_count: int) -> str | None:
        """Return why these cannot be the tables of a network with ``link_count`` links."""
        import numpy as np

        entries = len(self.links)
        levels = [len(limits) + 1 for limits in self.limits]
        if not self.link_count == len(levels) == link_count:
            return f"{self.link_count} rows and {len(levels)} limits for {link_count} links"
        if self.starts[0] != 0 or self.starts[-1] != entries or (np.diff(self.starts) < 0).any():
            return f"rows that do not cover its {entries} entries"
        for name, rows in (("shares", self.shares), ("hidden_factors", self.hidden_factors)):
            if [len(row) for row in rows] != levels:
                return f"{name} that do not fit the levels of its links"
        return self._entries_fault()

    def _entries_fault(self) -> str | None:
        import numpy as np

        entries = len(self.links)
        if not len(self.is_conflict) == len(self.hidden_units) == entries:
            return "arrays of entries of different lengths"
        if entries and not 0 <= int(self.links.min()) <= int(self.links.max()) < self.link_count:
            return "entries about links that do not exist"
        if np.any(self.hidden_units < 1, where=~self.is_conflict):
            return "a hidden power below one quantum"
        return None
