"""How urgent tasks are: the upward and downward ranks of HEFT and CPOP."""

from collections.abc import Iterable

from ncsim_saga.native.instance import Instance
from ncsim_saga.native.processors import Processors

CLEARLY_LESS = 1.0 - 1e-9
"""Factor below which a rough estimate is surely not the largest; its error is below 1e-12."""


def upward_ranks(instance: Instance, processors: Processors) -> list[float]:
    """Return for each task its mean time plus that of the longest way to an exit (s).

    Source: Section 4.1 of Topcuoglu et al. (2002), rank_u.
    """
    ranks_s = [0.0] * len(instance.costs)
    for task in reversed(instance.topological):
        ways = [(ranks_s[child], size_MB) for child, size_MB in instance.children[task]]
        ranks_s[task] = processors.mean_compute_s(instance.costs[task]) + longest_way_s(
            ways, processors
        )
    return ranks_s


def downward_ranks(instance: Instance, processors: Processors) -> list[float]:
    """Return for each task the longest way from an entry to its beginning (s).

    SAGA adds the task's own time at the mean capacity, where the publication adds its parent's.
    """
    ranks_s = [0.0] * len(instance.costs)
    for task in instance.topological:
        ways = [(ranks_s[parent], size_MB) for parent, size_MB in instance.parents[task]]
        if ways:
            own_s = instance.costs[task] / processors.mean_capacity
            ranks_s[task] = longest_way_s(ways, processors) + own_s
    return ranks_s


def longest_way_s(ways: Iterable[tuple[float, float]], processors: Processors) -> float:
    """Return the largest of rank plus mean transfer time; 0 if there are no ways.

    Mean transfer times cost most of the ranking on large networks, so they are worked out only
    for ways that may be the longest.

    Args:
        ways: Rank of the other task (s) and size of the dependency (MB).
        processors: Gives mean transfer times.
    """
    slowness = processors.network.mean_link_slowness
    rough = [(rank_s + size_MB * slowness, rank_s, size_MB) for rank_s, size_MB in ways]
    bar_s = max(rough, default=(0.0,))[0] * CLEARLY_LESS
    return max(
        (
            rank_s + processors.mean_transfer_s(size_MB)
            for rough_s, rank_s, size_MB in rough
            if rough_s >= bar_s
        ),
        default=0.0,
    )
