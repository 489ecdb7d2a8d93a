"""What the compiled loop noted, told to batch observers as the engine in Python tells it."""

from itertools import pairwise
from typing import Any, Final, TypeAlias

import numpy as np

from ncsim_core.contracts.interference_model import Against
from ncsim_core.contracts.interference_tables import InterferenceTables
from ncsim_core.engine.compiled import layout
from ncsim_core.engine.compiled.arrays import Arrays, records
from ncsim_core.engine.compiled.records import Record
from ncsim_core.engine.observer import RateColumns
from ncsim_core.engine.state import State

EVENTS_KEPT: Final = 4096
RATES_KEPT: Final = 16_384
"""How much is noted before observers are told; 1 MB."""

Rates: TypeAlias = dict[int, RateColumns]


class Teller:
    """Tells the observers of one run what the loop has noted.

    Args:
        arrays: Of the run; the loop's own log is put in.
        state: Whose log the observers are told from.
        tables: What the interference model knows of competition, if it has any.
    """

    def __init__(self, arrays: Arrays, state: State, tables: InterferenceTables | None) -> None:
        self._arrays = arrays
        self._log = state.log
        self._tables = tables
        record = arrays.state
        record.is_watched, record.shows_rates = state.log is not None, state.shows_rates
        record.happened_most = EVENTS_KEPT
        arrays.put("happened", records(EVENTS_KEPT if state.log else 0, layout.ARRAYS["happened"]))
        self._keep_rates(RATES_KEPT if state.shows_rates else 0)

    def _keep_rates(self, count: int) -> None:
        self._arrays.state.assigned_most = count
        self._arrays.put("assigned", records(count, layout.ARRAYS["assigned"]))

    def tell(self) -> None:
        """Tell all that has been noted; make room for one event at least."""
        record = self._arrays.state
        happened = self._arrays["happened"][: int(record.happened_count)]
        assigned = self._arrays["assigned"][: int(record.assigned_count)]
        if self._log is not None:
            self._log.events += happened.tolist()
            self._log.rates |= self._rates(happened.moves, assigned)
        record.happened_count = record.assigned_count = 0
        if record.shows_rates and record.flows >= record.assigned_most:
            self._keep_rates(2 * int(record.flows) + 2)
        if self._log is not None:
            self._log.tell()

    def _rates(self, moves: "np.ndarray[Any, np.dtype[np.int64]]", assigned: Record) -> Rates:
        """Return what events moved, by their place, transfers in order."""
        if not len(assigned):
            return {}
        event_of = np.repeat(np.arange(len(moves)), moves)
        assigned = assigned[np.lexsort((assigned.transfer, event_of))]
        names = ("transfer", "rate_MBps", "bottleneck", "flows")
        transfers, rates_MBps, links, flows = (assigned[name].tolist() for name in names)
        against = self._against(assigned)
        contenders, hidden, factors = against or ((), (), ())
        places = np.flatnonzero(moves)
        ends = np.cumsum(moves[places]).tolist()
        return {
            place: (
                transfers[first:end],
                rates_MBps[first:end],
                links[first:end],
                flows[first:end],
                against and (contenders[first:end], hidden[first:end], factors[first:end]),
            )
            for place, (first, end) in zip(places.tolist(), pairwise([0, *ends]), strict=True)
        }

    def _against(self, assigned: Record) -> Against | None:
        if self._tables is None:
            return None
        hidden_factors = self._tables.hidden_factors
        found = zip(assigned.bottleneck.tolist(), assigned.level.tolist(), strict=True)
        factors = [hidden_factors[link][level] for link, level in found]
        return assigned.contenders.tolist(), assigned.hidden.tolist(), factors
