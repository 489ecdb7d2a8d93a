"""What has happened and is told in batches."""

from collections.abc import Sequence

from ncsim_core.engine.event_queue import Due
from ncsim_core.engine.observer import Batch, BatchObserver, RateColumns


class Log:
    """Events that batch observers have not been told of.

    Args:
        observers: Who is told.

    Attributes:
        events: What has happened, in order.
        rates: What a start or finish moved, by its place among them.
    """

    __slots__ = ("events", "observers", "rates")

    def __init__(self, observers: Sequence[BatchObserver]) -> None:
        self.observers = tuple(observers)
        self.events: list[Due] = []
        self.rates: dict[int, RateColumns] = {}

    def tell(self) -> None:
        """Tell all that has been noted, once."""
        if not self.events:
            return
        batch = Batch(self.events, self.rates)
        try:
            for observer in self.observers:
                observer.events_happened(batch)
        finally:
            self.events.clear()
            self.rates.clear()
