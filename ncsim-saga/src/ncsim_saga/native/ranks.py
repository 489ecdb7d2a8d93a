"""How urgent tasks are: the upward and downward ranks of HEFT and CPOP.

A rank adds up mean transfer times over all virtual links, nodes squared of them. Where only
the order of ranks matters, a rough mean (size times mean slowness) does if no two ranks are so near
that its error could turn them around; elsewhere the exact mean, which agrees with SAGA's to the
last bit, is worked out where it is needed.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TypeAlias

from ncsim_saga.native.instance import Instance, Neighbours
from ncsim_saga.native.processors import Processors

UNIT_ROUNDING = 2.0**-53
ROUNDINGS_PER_TASK = 2
ROUNDINGS_OF_A_MEAN = 64
"""A sum of up to 2^27 quotients in numpy's grouping takes fewer, a rough mean takes four."""

LongestWay: TypeAlias = Callable[[Neighbours, Sequence[float]], float]
"""Gives the largest of rank plus mean transfer time over some neighbours; 0 if there are none."""


def by_urgency(instance: Instance, processors: Processors) -> list[int]:
    """Return tasks by falling upward rank; equals keep their topological order."""
    rough_s = upward_ranks(instance, processors, rough_longest_way(processors))
    order = _sorted(instance, rough_s)
    bar = 1.0 - 2 * relative_error(instance)
    clear = all(rough_s[later] < rough_s[sooner] * bar for sooner, later in pairwise(order))
    return order if clear else _sorted(instance, exact_upward_ranks(instance, processors))


def exact_upward_ranks(instance: Instance, processors: Processors) -> list[float]:
    """Return SAGA's upward ranks (s)."""
    return upward_ranks(instance, processors, exact_longest_way(instance, processors))


def upward_ranks(
    instance: Instance, processors: Processors, longest_way_s: LongestWay
) -> list[float]:
    """Return for each task its mean time plus that of the longest way to an exit (s).

    Source: Section 4.1 of Topcuoglu et al. (2002), rank_u.
    """
    ranks_s = [0.0] * len(instance.costs)
    for task in reversed(instance.topological):
        own_s = processors.mean_compute_s(instance.costs[task])
        ranks_s[task] = own_s + longest_way_s(instance.children[task], ranks_s)
    return ranks_s


def exact_downward_ranks(instance: Instance, processors: Processors) -> list[float]:
    """Return for each task the longest way from an entry to its beginning (s), as SAGA does.

    SAGA adds the task's own time at the mean capacity, where the publication adds its parent's.
    """
    ranks_s = [0.0] * len(instance.costs)
    longest_way_s = exact_longest_way(instance, processors)
    for task in instance.topological:
        if instance.parents[task]:
            own_s = instance.costs[task] / processors.mean_capacity
            ranks_s[task] = longest_way_s(instance.parents[task], ranks_s) + own_s
    return ranks_s


def rough_longest_way(processors: Processors) -> LongestWay:
    """Return a ``LongestWay`` by rough means."""
    slowness = processors.network.mean_link_slowness

    def longest_way_s(others: Neighbours, ranks_s: Sequence[float]) -> float:
        return max((ranks_s[other] + size_MB * slowness for other, size_MB in others), default=0.0)

    return longest_way_s


def exact_longest_way(instance: Instance, processors: Processors) -> LongestWay:
    """Return a ``LongestWay`` by exact means, worked out only for ways that may be longest."""
    slowness = processors.network.mean_link_slowness
    bar = 1.0 - 2 * relative_error(instance)
    rough_longest_way_s = rough_longest_way(processors)

    def longest_way_s(others: Neighbours, ranks_s: Sequence[float]) -> float:
        bar_s = rough_longest_way_s(others, ranks_s) * bar
        return max(
            (
                ranks_s[other] + processors.mean_transfer_s(size_MB)
                for other, size_MB in others
                if ranks_s[other] + size_MB * slowness >= bar_s
            ),
            default=0.0,
        )

    return longest_way_s


def relative_error(instance: Instance) -> float:
    """Return a bound on how far a rank is from the true sum, exact or rough, as a ratio.

    All terms are positive, so relative errors add up along a way and no further.
    """
    roundings = ROUNDINGS_PER_TASK * len(instance.costs) + ROUNDINGS_OF_A_MEAN
    return 2 * roundings * UNIT_ROUNDING


def _sorted(instance: Instance, ranks_s: Sequence[float]) -> list[int]:
    return sorted(instance.topological, key=ranks_s.__getitem__, reverse=True)
