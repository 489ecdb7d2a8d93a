"""The largest clique around each vertex of a graph, by branch and bound on bit sets."""

from collections.abc import Sequence


def largest_clique_sizes(neighbourhoods: Sequence[int]) -> list[int]:
    """Return for each vertex the size of the largest clique that contains it.

    A clique found for one vertex bounds the search of its other members from below, so that
    a graph with few large cliques is done quickly; the worst case is exponential.

    Args:
        neighbourhoods: By vertex, the set of its neighbours, vertex ``i`` being bit ``i``.

    >>> largest_clique_sizes([0b0110, 0b0101, 0b1011, 0b0100])
    [3, 3, 3, 2]
    """
    sizes = [1] * len(neighbourhoods)
    for vertex, candidates in enumerate(neighbourhoods):
        clique = _Search(neighbourhoods, sizes[vertex]).best_with([vertex], candidates)
        for member in clique:
            sizes[member] = max(sizes[member], len(clique))
    return sizes


class _Search:
    """Looks for a clique larger than one that is known.

    Args:
        neighbourhoods: By vertex, the set of its neighbours.
        known_size: A size that need not be found again.
    """

    def __init__(self, neighbourhoods: Sequence[int], known_size: int) -> None:
        self._neighbourhoods = neighbourhoods
        self._size = known_size
        self._best: list[int] = []

    def best_with(self, chosen: list[int], candidates: int) -> list[int]:
        """Return the largest clique of ``chosen`` and candidates, empty if none is larger."""
        self._expand(chosen, candidates)
        return self._best

    def _expand(self, chosen: list[int], candidates: int) -> None:
        for vertex, bound in reversed(self._coloured(candidates)):
            if len(chosen) + bound <= self._size:
                return
            grown = [*chosen, vertex]
            if len(grown) > self._size:
                self._size, self._best = len(grown), grown
            self._expand(grown, candidates & self._neighbourhoods[vertex])
            candidates &= ~(1 << vertex)

    def _coloured(self, candidates: int) -> list[tuple[int, int]]:
        """Return candidates with the number of colours that they and those before them need."""
        order = []
        colour = 0
        while candidates:
            colour += 1
            same_colour = candidates
            while same_colour:
                bit = same_colour & -same_colour
                vertex = bit.bit_length() - 1
                order.append((vertex, colour))
                candidates &= ~bit
                same_colour &= ~bit & ~self._neighbourhoods[vertex]
        return order
