"""What a component may know when it is built."""

import zlib
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar, cast

from ncsim_core.network import Network
from ncsim_core.workflow import Injection

if TYPE_CHECKING:
    import numpy as np

T = TypeVar("T")

MAX_CACHED_RESULTS = 64
MAX_CACHED_PAIRS = 500_000_000  # of links; some results hold ten bytes and more for each pair


class ModelCache:
    """Results that depend only on a network and options, shared by the runs of one process.

    The least recently used entry goes first. A cached value must never be changed. Threads may
    share a cache: at worst they build the same value twice.

    Args:
        max_entries: How many values are kept.
        max_weight: How much they may weigh together; the latest is kept whatever it weighs.
    """

    def __init__(
        self, max_entries: int = MAX_CACHED_RESULTS, max_weight: int = MAX_CACHED_PAIRS
    ) -> None:
        self._entries: dict[Hashable, tuple[object, int]] = {}
        self._max_entries = max_entries
        self._max_weight = max_weight

    def get_or_build(self, key: Hashable, build: Callable[[], T], weight: int = 0) -> T:
        """Return the value kept under ``key``, building it the first time.

        Args:
            key: What the value depends on.
            build: What makes it.
            weight: How much of ``max_weight`` it takes.
        """
        known = self._entries.pop(key, None)
        value = build() if known is None else cast("T", known[0])
        self._entries[key] = (value, weight)
        self._make_room(is_weighed=weight > 0)
        return value

    def _make_room(self, *, is_weighed: bool) -> None:
        """Drop entries that have long not been used; in steps that threads cannot disturb."""
        excess = len(self._entries) - self._max_entries
        weight = sum(each for _, each in list(self._entries.values())) if is_weighed else 0
        if excess <= 0 and weight <= self._max_weight:
            return
        for key in list(self._entries)[:-1]:
            if excess <= 0 and weight <= self._max_weight:
                return
            _, dropped = self._entries.pop(key, (None, 0))
            excess, weight = excess - 1, weight - dropped


SHARED_CACHE = ModelCache()


@dataclass(frozen=True)
class BuildContext:
    """Everything outside its own options that a component is built from.

    Args:
        network: The network; its ``rates`` are decided for every kind but link models.
        seed: The run's seed. Draw through ``rng``, never from a global generator.
        sections: Config sections such as ``rf``, defaults filled in, by name.
        injections: The scenario's own DAGs and their times, for DAG sources.
        cache: Where ``cached`` keeps its values.
    """

    network: Network
    seed: int = 42
    sections: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    injections: tuple[Injection, ...] = ()
    cache: ModelCache = SHARED_CACHE

    def section(self, name: str) -> Mapping[str, object]:
        """Return a config section, empty when the scenario has none."""
        return self.sections.get(name, {})

    def cached(self, key: Hashable, build: Callable[[], T]) -> T:
        """Return ``build()``, computed once per network and ``key`` in this process.

        The key must hold everything but the network that the value depends on.
        """
        pairs = len(self.network.links) ** 2
        return self.cache.get_or_build((self.network.topology, key), build, pairs)

    def rng(self, stream: str) -> "np.random.Generator":
        """Return a generator for a named stream; streams do not disturb each other."""
        import numpy as np

        return np.random.default_rng([self.seed, zlib.crc32(stream.encode())])
