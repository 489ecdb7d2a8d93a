"""Who may not send together, and who disturbs whom unheard: the static relations of links.

Both relations are kept as neighbour lists, because in a large network most links are far
apart. They are built in blocks of rows, so that memory stays proportional to the answer.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from ncsim_core.context import BuildContext
from ncsim_core.network import LinkIndex, Network
from numpy.typing import NDArray

from ncsim_wifi.phy.sensing import is_sensed
from ncsim_wifi.propagation import is_on_air, propagation
from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray, mW_from_dBm
from ncsim_wifi.radio import Radio

CELLS_PER_BLOCK = 1 << 21  # about 2 MB per boolean array while building

LinkArray = NDArray[np.int32]


@dataclass(frozen=True)
class Neighbours:
    """For each link a list of others: row ``i`` is ``links[starts[i]:starts[i + 1]]``.

    Args:
        starts: Where rows begin, shape ``(links + 1,)``.
        links: The neighbours, ascending within a row.
    """

    starts: IntArray
    links: LinkArray

    def row(self, link: LinkIndex) -> slice:
        """Return where the neighbours of a link are kept."""
        return slice(int(self.starts[link]), int(self.starts[link + 1]))

    def of(self, link: LinkIndex) -> LinkArray:
        """Return the neighbours of a link."""
        return self.links[self.row(link)]

    @property
    def link_count(self) -> int:
        """Return how many links have a row, possibly empty."""
        return len(self.starts) - 1

    @classmethod
    def none(cls, link_count: int) -> "Neighbours":
        """Return the relation in which no link has a neighbour."""
        return cls(np.zeros(link_count + 1, np.int64), np.zeros(0, np.int32))


@dataclass(frozen=True)
class Relations:
    """Conflict graph and hidden interference of one network.

    Args:
        conflicts: The conflict neighbourhood N of each link; symmetric.
        victims: For each link, the links outside its neighbourhood whose receivers hear its
            transmitter at the cutoff or above.
        victim_power_mW: With what power, one entry per entry of ``victims.links``.
    """

    conflicts: Neighbours
    victims: Neighbours
    victim_power_mW: FloatArray

    @property
    def link_count(self) -> int:
        """Return the number of links, wired ones included."""
        return self.conflicts.link_count

    @cached_property
    def interferers(self) -> Neighbours:
        """Return for each link the links that it is a victim of: ``victims`` turned round."""
        by_victim = np.argsort(self.victims.links, kind="stable")
        origins = np.repeat(np.arange(self.link_count), np.diff(self.victims.starts))
        counts = np.bincount(self.victims.links, minlength=self.link_count)
        return Neighbours(
            np.concatenate([[0], np.cumsum(counts)]), origins[by_victim].astype(np.int32)
        )

    def without_hidden(self) -> "Relations":
        """Return the relations of a world without hidden interference."""
        return replace(self, victims=Neighbours.none(self.link_count), victim_power_mW=np.zeros(0))

    def without_contention(self) -> "Relations":
        """Return the relations with hidden interference alone."""
        return replace(self, conflicts=Neighbours.none(self.link_count))


def relations(context: BuildContext, radio: Radio) -> Relations:
    """Return the relations of a network, worked out once per network and radio."""
    seed = context.seed if radio.shadow_fading_sigma > 0 else None
    return context.cached(
        ("ncsim_wifi.relations", radio, seed),
        lambda: relations_of(context.network, propagation(context, radio).power_dBm, radio),
    )


def relations_of(network: Network, power_dBm: FloatArray, radio: Radio) -> Relations:
    """Return who conflicts with whom, and who interferes unheard with what power.

    Source: Section IV-F (``sec:wifi``); SPEC 4 and 5.

    Args:
        network: Its wireless links are related, its wired ones to nobody.
        power_dBm: Received power by (sending node, receiving node).
        radio: Thresholds, and whether RTS/CTS is on.
    """
    on_air = np.flatnonzero([is_on_air(link) for link in network.links])
    ends = LinkEnds(np.array(network.sources)[on_air], np.array(network.targets)[on_air])
    hears = hearing(power_dBm, radio)
    is_audible = power_dBm >= radio.interference_cutoff_dBm
    conflicts, victims, powers_mW = _RowCollector(on_air), _RowCollector(on_air), [np.zeros(0)]
    for block in _blocks(len(on_air)):
        in_conflict = conflict_block(block, ends, hears, rts_cts=radio.rts_cts)
        hidden = is_audible[ends.sources[block]][:, ends.targets] & ~in_conflict
        own = np.arange(block.start, block.stop)
        in_conflict[own - block.start, own] = False
        hidden[own - block.start, own] = False
        conflicts.add(block, *np.nonzero(in_conflict))
        rows, columns = np.nonzero(hidden)
        victims.add(block, rows, columns)
        powers_mW.append(mW_from_dBm(power_dBm[ends.sources[block][rows], ends.targets[columns]]))
    count = len(network.links)
    return Relations(
        conflicts.neighbours(count), victims.neighbours(count), np.concatenate(powers_mW)
    )


@dataclass(frozen=True)
class LinkEnds:
    """The two nodes of each link, in link order."""

    sources: IntArray
    targets: IntArray


def hearing(power_dBm: FloatArray, radio: Radio) -> BoolArray:
    """Return which nodes sense each other; a node always senses itself."""
    hears = is_sensed(power_dBm, radio.cca_threshold_dBm)
    np.fill_diagonal(hears, val=True)
    return hears


def conflict_block(block: slice, ends: LinkEnds, hears: BoolArray, *, rts_cts: bool) -> BoolArray:
    """Return which links conflict with those of a block, shape ``(block, links)``.

    Without RTS/CTS two links conflict if either transmitter senses any node of the other;
    with it, if any node senses any node. Links that share an endpoint always conflict.

    Source: Section IV-F (``sec:wifi``), conflict graph; SPEC 4.
    """
    source_hears = hears[ends.sources[block]]
    target_hears = hears[ends.targets[block]]
    in_conflict: BoolArray = source_hears[:, ends.sources]
    in_conflict |= source_hears[:, ends.targets]
    in_conflict |= target_hears[:, ends.sources]
    if rts_cts:
        in_conflict |= target_hears[:, ends.targets]
    else:
        in_conflict |= ends.targets[block][:, None] == ends.targets[None, :]
    return in_conflict


class _RowCollector:
    """Gathers neighbour lists block by block.

    Args:
        on_air: Index in the network of each link that the blocks count.
    """

    def __init__(self, on_air: IntArray) -> None:
        self._on_air = on_air
        self._row_lengths = np.zeros(len(on_air), np.int64)
        self._columns: list[LinkArray] = [np.zeros(0, np.int32)]

    def add(self, block: slice, rows: IntArray, columns: IntArray) -> None:
        """Take the neighbours of a block; ``rows`` ascends and counts from the block's start."""
        self._row_lengths[block] = np.bincount(rows, minlength=block.stop - block.start)
        self._columns.append(self._on_air[columns].astype(np.int32))

    def neighbours(self, link_count: int) -> Neighbours:
        """Return the lists by index in the network; a link off the air has an empty one."""
        starts = np.zeros(link_count + 1, np.int64)
        starts[self._on_air + 1] = self._row_lengths
        return Neighbours(np.cumsum(starts), np.concatenate(self._columns))


def _blocks(row_count: int) -> Iterator[slice]:
    """Yield slices that cover all rows of a square matrix, none of too many cells."""
    height = max(1, CELLS_PER_BLOCK // max(1, row_count))
    for start in range(0, row_count, height):
        yield slice(start, min(start + height, row_count))
