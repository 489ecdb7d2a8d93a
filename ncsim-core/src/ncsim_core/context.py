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
_MISSING = object()


class ModelCache:
    """Results that depend only on a network and options, shared by the runs of one process.

    The least recently used entry goes first. A cached value must never be changed. Threads may
    share a cache: at worst they build the same value twice.
    """

    def __init__(self, max_entries: int = MAX_CACHED_RESULTS) -> None:
        self._entries: dict[Hashable, object] = {}
        self._max_entries = max_entries

    def get_or_build(self, key: Hashable, build: Callable[[], T]) -> T:
        """Return the value kept under ``key``, building it the first time."""
        known = self._entries.pop(key, _MISSING)
        value = build() if known is _MISSING else cast("T", known)
        self._entries[key] = value
        if len(self._entries) > self._max_entries:
            self._entries.pop(list(self._entries)[0], None)  # noqa: RUF015 - one step, for threads
        return value


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
        return self.cache.get_or_build((self.network.topology, key), build)

    def rng(self, stream: str) -> "np.random.Generator":
        """Return a generator for a named stream; streams do not disturb each other."""
        import numpy as np

        return np.random.default_rng([self.seed, zlib.crc32(stream.encode())])
