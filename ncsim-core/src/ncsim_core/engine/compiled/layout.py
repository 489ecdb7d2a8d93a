"""What the compiled loop works on: one record per task, transfer, hop, link and node.

A record's fields are those of the engine's own objects, in the same units. Lists are chains of
indices with ``NONE`` at their ends; a time that has not come is ``NOT_YET``.
"""

from collections.abc import Callable
from typing import Final

import numpy as np

from ncsim_core.compiling import inlined
from ncsim_core.engine.compiled.records import Record, reader, vector_reader

NONE: Final = -1
NOT_YET: Final = -1
PENDING, READY, QUEUED, RUNNING, COMPLETED = range(5)
"""Places in ``TaskStatus``."""


def _dtype(**fields: str) -> "np.dtype[np.void]":
    """Return a record of fields, given with their types: all their names, space between."""
    return np.dtype([(name, kind) for kind, names in fields.items() for name in names.split()])


TASK: Final = _dtype(
    f8="cost",
    i8="node missing status ready_us started_us ended_us first_outgoing end_outgoing behind",
)
"""``behind`` is who waits next on the same node."""

TRANSFER: Final = _dtype(
    f8="size_MB remaining_MB rate_MBps",
    i8="source target rank first_hop end_hop latency_us created_us started_us ended_us credited_us "
    "bottleneck completes_us place looked_at",
)
"""``place`` is that of its completion in the queue, ``looked_at`` the number of the last refresh
that has looked at it."""

HOP: Final = _dtype(i4="link transfer ahead behind")
"""``ahead`` and ``behind`` are its neighbours among the hops that use the link now."""

LINK: Final = _dtype(f8="bandwidth_MBps factor share_MBps", i8="flows first_hop last_hop heard")
"""``heard`` are the active links that affect it, counted while rates are watched."""

NODE: Final = _dtype(f8="capacity", i8="task waiting first_waiting last_waiting")
ENTRY: Final = _dtype(i8="at_us order number")
MOVE: Final = _dtype(f8="rate_MBps", i8="transfer bottleneck")
NUMBER: Final = _dtype(i8="number")
WINDOW: Final = _dtype(i8="mask start", u8="width")
LEVEL: Final = _dtype(i8="limit share_row is_constant")

ARRAYS: Final = {
    "tasks": TASK,
    "transfers": TRANSFER,
    "hops": HOP,
    "links": LINK,
    "nodes": NODE,
    "outgoing": NUMBER,  # dependencies that tasks feed, task by task
    "created": NUMBER,  # transfers, in that order
    "queue": ENTRY,  # a heap
    "switched": NUMBER,  # links that one change has switched
    "affected": NUMBER,  # transfers that it makes the engine look at
    "moves": MOVE,  # those whose rate moves
    "loads": NUMBER,  # by link
    "windows": WINDOW,  # by link
    "matrix": NUMBER,  # what links add to loads, row by row; empty for large networks
    "changed": NUMBER,  # links whose factor has changed
    "rows": NUMBER,  # by link, where the links begin that it affects
    "affected_links": _dtype(i4="link"),
    "conflicts": np.dtype([("is_conflict", "?")]),
    "hidden": _dtype(i8="units"),
    "levels": LEVEL,  # by link, then level
    "shares": _dtype(f8="factor"),  # by row, then stations; not a number where not worked out yet
    "happened": _dtype(i8="at_us kind moves number"),
    "assigned": _dtype(f8="rate_MBps", i8="transfer bottleneck flows contenders hidden level"),
}
"""The arrays of a run; lists are in them from the front."""

STATE: Final = _dtype(
    i8="now_us events unfinished_tasks last_task_end_us last_us max_events "
    "due_us due_kind due_number entries tickets flows refreshes refreshing is_stalled "
    "hop_count created_count affected_count moves_count "
    "has_radio has_matrix link_count level_count share_count count_shift looked_up changed_count "
    "is_watched shows_rates happened_count happened_most assigned_count assigned_most "
    + " ".join(ARRAYS),
)
"""What is there once: numbers, and the addresses of the arrays."""


def array_at(name: str) -> Callable[[int, Record], Record]:
    """Return what gives the record of a number in one of the arrays."""
    read, size = reader(ARRAYS[name]), ARRAYS[name].itemsize

    def record_at(number: int, state: Record) -> Record:
        return read(state[name] + number * size)

    return inlined(record_at)


task_at: Final = array_at("tasks")
transfer_at: Final = array_at("transfers")
outgoing_at: Final = array_at("outgoing")
created_at: Final = array_at("created")
hop_at: Final = array_at("hops")
link_at: Final = array_at("links")
node_at: Final = array_at("nodes")
entry_at: Final = array_at("queue")
switched_at: Final = array_at("switched")
affected_at: Final = array_at("affected")
move_at: Final = array_at("moves")
load_at: Final = array_at("loads")
window_at: Final = array_at("windows")
changed_at: Final = array_at("changed")
row_at: Final = array_at("rows")
affected_link_at: Final = array_at("affected_links")
conflict_at: Final = array_at("conflicts")
hidden_at: Final = array_at("hidden")
level_at: Final = array_at("levels")
share_at: Final = array_at("shares")
happened_at: Final = array_at("happened")
assigned_at: Final = array_at("assigned")
vector_at: Final = vector_reader()
