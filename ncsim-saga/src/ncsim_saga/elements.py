"""SAGA's set elements with hashes that do not follow ``PYTHONHASHSEED``.

Importing this module imports SAGA (0.5 to 3 s); only ``translate`` and ``planning`` do so, when a
plan is made.
"""

import saga
from typing_extensions import override

from ncsim_saga.hash_order import name_hash, pair_hash


class SeededNode(saga.NetworkNode):  # type: ignore[misc]  # saga is untyped
    """A node whose hash is that of seed 0."""

    @override
    def __hash__(self) -> int:
        return name_hash(self.name)


class SeededLink(saga.NetworkEdge):  # type: ignore[misc]
    """A virtual link whose hash is that of seed 0."""

    @override
    def __hash__(self) -> int:
        return pair_hash(self.source, self.target)


class SeededTask(saga.TaskGraphNode):  # type: ignore[misc]
    """A task whose hash is that of seed 0."""

    @override
    def __hash__(self) -> int:
        return name_hash(self.name)


class SeededDependency(saga.TaskGraphEdge):  # type: ignore[misc]
    """A dependency whose hash is that of seed 0."""

    @override
    def __hash__(self) -> int:
        return pair_hash(self.source, self.target)
