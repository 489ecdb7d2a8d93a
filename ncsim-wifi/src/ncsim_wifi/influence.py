"""What switching one link does to the others, as one number to add.

Contenders and hidden power of a link are packed into one whole number, its *load*: the number
of contenders above bit ``count_shift``, the hidden sum in quanta below it. A link that is
switched adds one precomputed number to the load of each link that it affects.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from ncsim_core.network import LinkIndex

from ncsim_wifi.conflict import Relations
from ncsim_wifi.levels import UNIT_BITS, Levels
from ncsim_wifi.quantities import IntArray

LOAD_BITS = 62  # of a signed 64-bit number, one spare
ENTRIES_PER_BLOCK = 1 << 20  # so that no second array of all entries is needed


@dataclass(frozen=True)
class Influence:
    """Relations of links as numbers to add to loads.

    Args:
        related: Which links affect which.
        increments: What each entry adds, in the order of ``related.links``.
        count_shift: How many bits of a load the hidden sum has.
    """

    related: Relations
    increments: IntArray
    count_shift: int

    @property
    def fits(self) -> bool:
        """Return whether no set of active links can overflow a 64-bit load."""
        most_contenders = int(self.related.conflict_counts.max(initial=0))
        return self.count_shift + most_contenders.bit_length() <= LOAD_BITS

    @cached_property
    def rows(self) -> list[list[int]]:
        """Return the increments by (switched link, other link), for small networks."""
        rows: list[list[int]] = self.matrix.tolist()
        return rows

    @cached_property
    def matrix(self) -> IntArray:
        """Return the increments by (switched link, other link)."""
        count = self.related.link_count
        matrix = np.zeros((count, count), np.int64)
        matrix[self.related.origins, self.related.links] = self.increments
        return matrix

    @property
    def units_mask(self) -> int:
        """Return the bits of a load that hold the hidden sum."""
        return (1 << self.count_shift) - 1

    def contenders(self, load: int) -> int:
        """Return the number of active contenders in a load."""
        return load >> self.count_shift

    def hidden_units(self, load: int) -> int:
        """Return the hidden sum in a load."""
        return load & self.units_mask

    def load(self, contenders: int, hidden_units: int) -> int:
        """Return the load of a number of contenders and a hidden sum."""
        return (contenders << self.count_shift) + hidden_units

    def interferers(self, link: LinkIndex, active: IntArray, load: int) -> int:
        """Return how many of the ``active`` links interfere with ``link`` unheard."""
        affecting = np.isin(self.related.affecting(link), active, assume_unique=True)
        return int(np.count_nonzero(affecting)) - self.contenders(load)


def influence_of(related: Relations, levels: Levels) -> Influence:
    """Return the influence of every link on every other."""
    counts = np.bincount(related.links[~related.is_conflict], minlength=1)
    count_shift = UNIT_BITS + int(counts.max()).bit_length()
    increments = np.full(len(related.links), 1 << min(count_shift, LOAD_BITS), np.int64)
    for start in range(0, len(increments), ENTRIES_PER_BLOCK):
        block = slice(start, start + ENTRIES_PER_BLOCK)
        hidden = np.flatnonzero(~related.is_conflict[block]) + start
        increments[hidden] = levels.units(related.links[hidden], related.power_mW[hidden])
    return Influence(related, increments, count_shift)
