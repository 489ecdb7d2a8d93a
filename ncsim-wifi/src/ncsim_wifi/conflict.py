"""Who may not send together, and who disturbs whom unheard: the static relations of links.

Relations are kept as neighbour lists, because in a large network most links are far apart, and
built in blocks of rows into arrays of the right length, so that building needs little more
memory than the answer.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from ncsim_core.context import BuildContext
from ncsim_core.network import LinkIndex, Network
from numpy.typing import NDArray

from ncsim_wifi.phy.sensing import is_sensed
from ncsim_wifi.propagation import is_on_air, propagation
from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray, mW_from_dBm
from ncsim_wifi.radio import Radio

CELLS_PER_BLOCK = 1 << 20  # about 1 MB per boolean array while building

LinkArray = NDArray[np.int32]


@dataclass(frozen=True)
class Relations:
    """Which links affect which: conflict graph and hidden interference of one network.

    Row ``i`` holds the links that are affected when link ``i`` is active, ascending:
    ``links[starts[i]:starts[i + 1]]``, and so on for the other arrays.

    Args:
        starts: Where rows begin, shape ``(links + 1,)``.
        links: The affected links. They are in the conflict neighbourhood N of ``i``, or
            outside it with a receiver that hears the transmitter of ``i`` at the
            cutoff or above.
        is_conflict: Which of the two; conflicts are mutual.
        hidden_starts: Where rows begin in ``hidden_mW``, shape ``(links + 1,)``.
        hidden_mW: Received power of ``i`` at the receivers of the links that it is hidden
            from, in the order of ``links``; that of conflicts is of no interest.
    """

    starts: IntArray
    links: LinkArray
    is_conflict: BoolArray
    hidden_starts: IntArray
    hidden_mW: FloatArray

    @property
    def link_count(self) -> int:
        """Return the number of links, wired ones included."""
        return len(self.starts) - 1

    def row(self, link: LinkIndex) -> slice:
        """Return where the links affected by one are kept."""
        return slice(int(self.starts[link]), int(self.starts[link + 1]))

    def affected(self, link: LinkIndex) -> LinkArray:
        """Return the links affected by one."""
        return self.links[self.row(link)]

    def conflicts(self, link: LinkIndex) -> LinkArray:
        """Return the conflict neighbourhood N of a link."""
        row = self.row(link)
        return self.links[row][self.is_conflict[row]]

    def hidden(self, link: LinkIndex) -> tuple[LinkArray, FloatArray]:
        """Return the links that one interferes with unheard, and its power at their receivers."""
        row = self.row(link)
        powers = slice(int(self.hidden_starts[link]), int(self.hidden_starts[link + 1]))
        return self.links[row][~self.is_conflict[row]], self.hidden_mW[powers]

    def reach(self, changed: Collection[LinkIndex]) -> set[LinkIndex]:
        """Return ``changed`` and all links affected by them."""
        reached = set(changed)
        for link in changed:
            reached.update(self.affected(link).tolist())
        return reached

    @cached_property
    def conflict_counts(self) -> IntArray:
        """Return the degree of each link in the conflict graph."""
        rows = (self.is_conflict[self.row(link)] for link in range(self.link_count))
        return np.fromiter((np.count_nonzero(row) for row in rows), np.int64, self.link_count)

    @cached_property
    def origins(self) -> LinkArray:
        """Return the row of each entry."""
        rows = np.arange(self.link_count, dtype=np.int32)
        return np.repeat(rows, np.diff(self.starts))

    @cached_property
    def _turned_round(self) -> tuple[IntArray, LinkArray]:
        by_affected = np.argsort(self.links, kind="stable")
        counts = np.bincount(self.links, minlength=self.link_count)
        return np.concatenate([[0], np.cumsum(counts)]), self.origins[by_affected]

    def affecting(self, link: LinkIndex) -> LinkArray:
        """Return the links that affect one."""
        starts, origins = self._turned_round
        return origins[starts[link] : starts[link + 1]]

    def where(self, is_kept: BoolArray) -> "Relations":
        """Return the relations with some entries only."""
        kept_before = np.concatenate([[0], np.cumsum(is_kept)])
        is_hidden_kept = is_kept[~self.is_conflict]
        hidden_before = np.concatenate([[0], np.cumsum(is_hidden_kept)])
        return Relations(
            kept_before[self.starts],
            self.links[is_kept],
            self.is_conflict[is_kept],
            hidden_before[self.hidden_starts],
            self.hidden_mW[is_hidden_kept],
        )


def relations(context: BuildContext, radio: Radio) -> Relations:
    """Return the relations of a network, worked out once per network and radio."""
    return context.cached(
        ("ncsim_wifi.relations", radio, radio.draws_from(context.seed)),
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
    power_mW = mW_from_dBm(power_dBm)
    power_mW[power_dBm < radio.interference_cutoff_dBm] = 0.0
    air = Air(
        LinkEnds(np.array(network.sources)[on_air], np.array(network.targets)[on_air]),
        hearing(power_dBm, radio),
        power_mW,
        radio.rts_cts,
    )
    starts, hidden_starts = _starts(air, on_air, len(network.links))
    links, names = np.empty(starts[-1], np.int32), on_air.astype(np.int32)
    is_conflict, hidden_mW = np.empty(starts[-1], np.bool_), np.empty(hidden_starts[-1])
    for block in _blocks(len(on_air)):
        found = air.related(block)
        cells = np.flatnonzero(found.is_related)
        first, end = on_air[block.start], on_air[block.stop - 1] + 1
        entries = slice(starts[first], starts[end])
        links[entries] = names[cells % len(on_air)]
        is_conflict[entries] = found.is_conflict.ravel()[cells]
        hidden_cells = cells[~is_conflict[entries]]
        hidden_mW[hidden_starts[first] : hidden_starts[end]] = found.power_mW.ravel()[hidden_cells]
    return Relations(starts, links, is_conflict, hidden_starts, hidden_mW)


def _starts(air: "Air", on_air: IntArray, link_count: int) -> tuple[IntArray, IntArray]:
    """Return where the rows of all relations begin, and those of hidden interference."""
    lengths = np.zeros((2, link_count + 1), np.int64)
    for block in _blocks(len(on_air)):
        found = air.related(block)
        lengths[0, on_air[block] + 1] = np.count_nonzero(found.is_related, axis=1)
        found.is_related[found.is_conflict] = False
        lengths[1, on_air[block] + 1] = np.count_nonzero(found.is_related, axis=1)
    starts, hidden_starts = np.cumsum(lengths, axis=1)
    return starts, hidden_starts


@dataclass(frozen=True)
class LinkEnds:
    """The two nodes of each link, in link order."""

    sources: IntArray
    targets: IntArray


@dataclass(frozen=True)
class RelatedBlock:
    """How the links of a block (rows) affect all links (columns)."""

    is_related: BoolArray
    is_conflict: BoolArray
    power_mW: FloatArray


@dataclass(frozen=True)
class Air:
    """What all wireless links of a network have in common.

    Asked twice for each block, once to count and once to keep: computing is cheaper than
    holding what the answer will hold.

    Args:
        ends: Their nodes.
        hears: Which nodes sense each other.
        power_mW: Received power by (sending node, receiving node), 0 below the cutoff.
        rts_cts: Whether RTS/CTS is on.
    """

    ends: LinkEnds
    hears: BoolArray
    power_mW: FloatArray
    rts_cts: bool

    def related(self, block: slice) -> RelatedBlock:
        """Return how the links of a block affect all links."""
        in_conflict = conflict_block(block, self.ends, self.hears, rts_cts=self.rts_cts)
        at_receivers_mW = self.power_mW[self.ends.sources[block]].take(self.ends.targets, axis=1)
        is_related = at_receivers_mW > 0.0
        is_related |= in_conflict
        own = np.arange(block.start, block.stop)
        is_related[own - block.start, own] = False  # no link is its own neighbour
        return RelatedBlock(is_related, in_conflict, at_receivers_mW)


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
    in_conflict: BoolArray = (source_hears | target_hears).take(ends.sources, axis=1)
    if rts_cts:
        source_hears |= target_hears
    in_conflict |= source_hears.take(ends.targets, axis=1)
    in_conflict |= ends.targets[block][:, None] == ends.targets[None, :]
    return in_conflict


def _blocks(row_count: int) -> Iterator[slice]:
    """Yield slices that cover all rows of a square matrix, none of too many cells."""
    height = max(1, CELLS_PER_BLOCK // max(1, row_count))
    for start in range(0, row_count, height):
        yield slice(start, min(start + height, row_count))
