"""What switching one link does to the others, as one number to add.

Contenders and hidden sum of a link are packed into one whole number, its *load*: the number of
contenders above bit ``count_shift``, the hidden sum below it. A link that is switched adds one
precomputed number to the load of each link that it affects.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ncsim_core.contracts.interference_tables import InterferenceTables
from ncsim_core.network import LinkIndex

LOAD_BITS = 62  # of a signed 64-bit number, one spare
ENTRIES_PER_BLOCK = 1 << 20  # so that no second array of all entries is needed


@dataclass(frozen=True, eq=False)
class Loads:
    """Tables as numbers to add to loads.

    Args:
        tables: Which links affect which.
        count_shift: How many bits of a load the hidden sum has.
        most_contenders: How many contenders a link can have at most.
        fits: Whether no set of active links can overflow a load.
    """

    tables: InterferenceTables
    count_shift: int
    most_contenders: int
    fits: bool

    @property
    def units_mask(self) -> int:
        """Return the bits of a load that hold the hidden sum."""
        return (1 << self.count_shift) - 1

    @property
    def contender(self) -> int:
        """Return what a contender adds to a load; a hidden interferer adds its power."""
        return 1 << self.count_shift

    def increments(self, entries: slice) -> NDArray[np.int64]:
        """Return what some entries of the tables add to loads."""
        tables = self.tables
        return np.where(tables.is_conflict[entries], self.contender, tables.hidden_units[entries])

    @cached_property
    def matrix(self) -> NDArray[np.int64]:
        """Return the increments by (switched link, other link), for networks of some size."""
        count = self.tables.link_count
        matrix = np.zeros((count, count), np.int64)
        matrix[self._origins, self.tables.links] = self.increments(slice(None))
        return matrix

    @cached_property
    def rows(self) -> list[list[int]]:
        """Return the increments by (switched link, other link), for small networks."""
        rows: list[list[int]] = self.matrix.tolist()
        return rows

    @cached_property
    def _origins(self) -> NDArray[np.intp]:
        return np.repeat(np.arange(self.tables.link_count), np.diff(self.tables.starts))

    @cached_property
    def _affecting(self) -> tuple[NDArray[np.int64], NDArray[np.intp]]:
        """Return where the links that affect each link begin, and these links."""
        by_affected = np.argsort(self.tables.links, kind="stable")
        counts = np.bincount(self.tables.links, minlength=self.tables.link_count)
        return np.concatenate([[0], np.cumsum(counts)]), self._origins[by_affected]

    @cached_property
    def _masks(self) -> dict[LinkIndex, int]:
        return {}

    def affecting_mask(self, link: LinkIndex) -> int:
        """Return the links that affect one, as the bits of a whole number."""
        mask = self._masks.get(link)
        if mask is None:
            starts, origins = self._affecting
            flags = np.zeros(self.tables.link_count, np.uint8)
            flags[origins[starts[link] : starts[link + 1]]] = 1
            packed = np.packbits(flags, bitorder="little").tobytes()
            mask = self._masks[link] = int.from_bytes(packed, "little")
        return mask


def loads_from(tables: InterferenceTables) -> Loads:
    """Return the loads that tables amount to."""
    is_hidden = ~tables.is_conflict
    most_units = int(np.max(tables.hidden_units, initial=0, where=is_hidden))
    count_shift = most_units.bit_length() + _most_affecting(tables, is_hidden).bit_length()
    most_contenders = _most_affecting(tables, tables.is_conflict)
    fits = count_shift + most_contenders.bit_length() <= LOAD_BITS
    return Loads(tables, count_shift, most_contenders, fits)


def _most_affecting(tables: InterferenceTables, is_counted: NDArray[np.bool_]) -> int:
    """Return the greatest number of counted entries about one link."""
    counts = np.zeros(tables.link_count, np.int64)
    for start in range(0, len(tables.links), ENTRIES_PER_BLOCK):
        block = slice(start, start + ENTRIES_PER_BLOCK)
        links = tables.links[block][is_counted[block]]
        counts += np.bincount(links, minlength=tables.link_count)
    return int(counts.max(initial=0))
