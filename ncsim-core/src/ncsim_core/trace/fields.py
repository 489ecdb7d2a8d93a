"""How records look in a file, field by field.

``RECORDS`` is the only list of fields. The reader checks by it, ``trace_schema`` is made of it,
and every header carries its texts under ``kinds``, so that a trace explains itself.
"""

from collections.abc import Mapping
from typing import Final, NamedTuple

from ncsim_core.trace import shapes
from ncsim_core.trace.records import (
    Done,
    Ended,
    Injected,
    Note,
    Placed,
    RatesAssigned,
    Ready,
    Started,
    TraceRecord,
    TransferEnded,
    TransferStarted,
)
from ncsim_core.trace.shapes import Shape


class Field(NamedTuple):
    """One field of a record: its key, shape and meaning."""

    key: str
    shape: Shape
    meaning: str


class RecordSpec(NamedTuple):
    """One kind of record; ``fields`` in the order of the class after ``line`` and ``at_us``."""

    type: type[TraceRecord]
    fields: tuple[Field, ...]


_TASK: Final = (Field("i", shapes.COUNT, "task"), Field("n", shapes.COUNT, "node"))
_TRANSFER: Final = Field("x", shapes.COUNT, "transfer: the number of its edge")

RECORDS: Final[Mapping[str, RecordSpec]] = {
    "inject": RecordSpec(
        Injected,
        (
            Field("d", shapes.COUNT, "DAG number, counted in order of injection"),
            Field("dag", shapes.TEXT, "DAG id"),
            Field("i0", shapes.COUNT, "number of its first task; the others follow"),
            Field("x0", shapes.COUNT, "number of its first edge; the others follow"),
            Field("tasks", shapes.TASK_ROWS, "[id, cost in compute units] of each task"),
            Field("edges", shapes.EDGE_ROWS, "[producing task, waiting task, size in MB]"),
        ),
    ),
    "place": RecordSpec(
        Placed,
        (
            Field("d", shapes.COUNT, "DAG number"),
            Field("n", shapes.COUNTS, "node of each of its tasks"),
        ),
    ),
    "ready": RecordSpec(Ready, _TASK),
    "start": RecordSpec(Started, _TASK),
    "end": RecordSpec(Ended, _TASK),
    "xstart": RecordSpec(
        TransferStarted,
        (
            _TRANSFER,
            Field("route", shapes.COUNTS, "links in order from source to target"),
            Field("size", shapes.QUANTITY, "payload in MB"),
        ),
    ),
    "recalc": RecordSpec(
        RatesAssigned,
        (
            Field("by", shapes.CAUSE, 'cause: ["s" start | "e" end, transfer]'),
            Field("x", shapes.COUNTS, "transfers whose rate moved"),
            Field("r", shapes.QUANTITIES, "new rate of each in MB/s, full precision; 0 = paused"),
            Field("l", shapes.COUNTS, "bottleneck link of each"),
            Field("nc", shapes.COUNTS, "contenders of that link"),
            Field("nh", shapes.COUNTS, "hidden interferers of that link"),
            Field("fh", shapes.QUANTITIES, "factor that hidden interferers alone explain"),
            Field("f", shapes.COUNTS, "transfers that share that link, this one included"),
        ),
    ),
    "xend": RecordSpec(TransferEnded, (_TRANSFER,)),
    "note": RecordSpec(
        Note,
        (
            Field("ns", shapes.TEXT, "who wrote it, such as the name of a plug-in"),
            Field("data", shapes.ANYTHING, "what was written"),
        ),
    ),
    "done": RecordSpec(
        Done,
        (
            Field("status", shapes.TEXT, "why the run stopped"),
            Field("makespan_us", shapes.COUNT_OR_NULL, "when the last task ended; null if not all"),
            Field("events", shapes.COUNT, "events handled"),
            Field("detail", shapes.TEXT, "what to know about an end other than completed"),
            Field("counts", shapes.COUNT_BY_TEXT, "records of each kind before this one"),
        ),
    ),
}

HEADER_FIELDS: Final = (
    Field("format", shapes.TEXT, "always ncsim-trace"),
    Field("version", shapes.TEXT, "major.minor of the format"),
    Field("time_unit", shapes.TEXT, "unit of every t: us, microseconds"),
    Field("level", shapes.TEXT, "full, or coarse (without recalc records)"),
    Field("software", shapes.TEXT, "what ran the scenario"),
    Field("scenario", shapes.TEXT, "name of the scenario"),
    Field("scenario_sha256", shapes.TEXT, "hash of the resolved scenario"),
    Field(
        "seed",
        shapes.Shape("a whole number", lambda v: type(v) is int, {"type": "integer"}),
        "seed of the run",
    ),
    Field("plugins", shapes.OBJECT, "by kind: name, distribution, version, factory, options"),
    Field("sections", shapes.OBJECT, "resolved config sections such as rf"),
    Field("nodes", shapes.NODE_ROWS, "[id, capacity in units/s, x_m, y_m]"),
    Field(
        "links", shapes.LINK_ROWS, "[id, source node, target node, clean MB/s, latency s, medium]"
    ),
    Field("kinds", shapes.OBJECT, "kinds of record: what each field means"),
)


def kinds_documented() -> dict[str, dict[str, str]]:
    """Return for each kind what its fields mean, as the header carries it."""
    return {
        kind: {"t": "time in microseconds"} | {each.key: each.meaning for each in spec.fields}
        for kind, spec in RECORDS.items()
    }
