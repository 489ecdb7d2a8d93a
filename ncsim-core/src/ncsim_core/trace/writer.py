"""Writes the trace of a run while it goes on, in constant memory."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.metadata import version
from operator import attrgetter, itemgetter
from pathlib import Path
from types import TracebackType
from typing import Final, Self, TextIO

from msgspec import Raw, Struct
from typing_extensions import override

from ncsim_core.contracts.interference_model import Against
from ncsim_core.engine.events import (
    DAG_INJECT,
    TASK_COMPLETE,
    TASK_READY,
    TASK_START,
    TRANSFER_COMPLETE,
    TRANSFER_START,
)
from ncsim_core.engine.observer import Batch, BatchObserver, RateColumns
from ncsim_core.engine.outcome import Outcome
from ncsim_core.engine.setup import Setup
from ncsim_core.models import ComponentIdentity
from ncsim_core.network import NodeIndex
from ncsim_core.trace.encoding import (
    EndRecord,
    NoteRecord,
    RateRecord,
    StartRecord,
    TaskRecord,
    json_bytes,
    line_of,
    lines_of,
)
from ncsim_core.trace.fields import RECORDS, kinds_documented
from ncsim_core.trace.files import LineSink
from ncsim_core.trace.records import FORMAT, TIME_UNIT, VERSION, TraceHeader, TraceLevel
from ncsim_core.trace.tables import injected_record, link_rows, node_rows
from ncsim_core.units import Instant

TASK_KINDS: Final = {TASK_READY: "ready", TASK_START: "start", TASK_COMPLETE: "end"}
KINDS: Final = {
    **TASK_KINDS,
    TRANSFER_START: "xstart",
    TRANSFER_COMPLETE: "xend",
    DAG_INJECT: "",  # there is a record already
}
"""Kinds of record by kind of event."""

KIND_OF: Final = itemgetter(1)
BY: Final = {TRANSFER_START: "s", TRANSFER_COMPLETE: "e"}


class TraceWriter(BatchObserver):
    """Observer that writes a trace.

    Give it a path and it writes to a temporary name beside it, compressed if the name ends in
    ``.gz``, and renames when the run has ended; leaving a ``with`` block before that leaves no
    file. Give it an open text stream and it writes there and closes nothing.

    Args:
        target: Path or text stream.
        header: What the trace says about its scenario.
        level: ``full``, or ``coarse`` to leave ``recalc`` records out.
        is_live: Write under the final name, and to disk after every batch, for those who follow
            a run.
    """

    def __init__(
        self,
        target: Path | str | TextIO,
        header: TraceHeader | None = None,
        level: TraceLevel = "full",
        *,
        is_live: bool = False,
    ) -> None:
        self.wants_rates = level == "full"
        self._header = header or TraceHeader()
        self._level = level
        self._sink = LineSink(target, is_live=is_live)
        self._counts: Counter[str] = Counter()
        self._nodes: list[NodeIndex] = []  # by task, as far as DAGs have entered
        self._notes: list[NoteRecord] = []  # that wait for the events before them
        self._setup: Setup | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        error_type: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._sink.discard()

    @override
    def run_started(self, setup: Setup) -> None:
        self._setup = setup
        self._sink.write(line_of(header_document(self._header, self._level, setup)))

    @override
    def dag_injected(self, at_us: Instant, dag: int, nodes: Sequence[NodeIndex]) -> None:
        assert self._setup is not None  # the engine starts runs before it injects
        self._nodes += map(int, nodes)
        injected = injected_record(self._setup, at_us, dag)
        keys = (field.key for field in RECORDS["inject"].fields)
        fields = dict(zip(keys, injected[2:], strict=True))
        self._write("inject", at_us, fields)
        self._write("place", at_us, {"d": dag, "n": self._nodes[injected.first_task :]})

    @override
    def events_happened(self, batch: Batch) -> None:
        assert self._setup is not None
        nodes, rates = self._nodes, batch.rates if self.wants_rates else {}
        dependencies, routes = self._setup.dependencies, self._setup.routes
        records: list[Struct] = []
        put, task_kind_of = records.append, TASK_KINDS.get
        for place, (at_us, kind, _, number) in enumerate(batch.events):
            name = task_kind_of(kind)
            if name is not None:
                put(TaskRecord(at_us, name, number, nodes[number]))
                continue
            if kind == TRANSFER_START:
                entry = dependencies[number]
                route = routes.route(nodes[entry.source], nodes[entry.target])
                put(StartRecord(at_us, "xstart", number, route or (), entry.size_MB))
            elif kind == TRANSFER_COMPLETE:
                put(EndRecord(at_us, "xend", number))
            columns = rates.get(place)
            if columns is not None:
                put(rate_record(at_us, (BY[kind], number), columns))
        for kind, count in Counter(map(KIND_OF, batch.events)).items():
            self._counts[KINDS[kind]] += count
        self._counts["recalc"] += len(rates)
        if self._notes:
            records = sorted([*records, *self._notes], key=attrgetter("t"))
            self._notes.clear()
        self._sink.write(lines_of(records))

    def note(self, at_us: Instant, namespace: str, data: object) -> None:
        """Put something of a plug-in on record, under the plug-in's name, after all before it."""
        self._counts["note"] += 1
        said = Raw(json_bytes(namespace)), Raw(json_bytes(data))
        self._notes.append(NoteRecord(at_us, "note", *said))

    @override
    def run_ended(self, outcome: Outcome) -> None:
        fields = {
            "status": str(outcome.status),
            "makespan_us": outcome.makespan_us,
            "events": outcome.events,
            "detail": outcome.detail,
            "counts": {kind: self._counts[kind] for kind in RECORDS if self._counts[kind]},
        }
        self._write("done", outcome.ended_us, fields)
        self._sink.finish()

    def _write(self, kind: str, at_us: Instant, fields: Mapping[str, object]) -> None:
        self._counts[kind] += 1
        self._sink.write(lines_of(self._notes) + line_of({"t": at_us, "k": kind, **fields}))
        self._notes.clear()


def rate_record(at_us: Instant, cause: tuple[str, int], columns: RateColumns) -> RateRecord:
    """Return the ``recalc`` of some rates."""
    transfers, rates_MBps, links, flows, against = columns
    contenders, hidden, factors = against or alone(len(links))
    return RateRecord(
        at_us, "recalc", cause, transfers, rates_MBps, links, contenders, hidden, factors, flows
    )


@cache
def alone(count: int) -> Against:
    """Return what several links are up against that compete with nobody."""
    return (0,) * count, (0,) * count, (1.0,) * count


def header_document(header: TraceHeader, level: TraceLevel, setup: Setup) -> dict[str, object]:
    """Return the first line of a trace as an object."""
    identities = setup.models.identities
    return {
        "format": FORMAT,
        "version": VERSION,
        "time_unit": TIME_UNIT,
        "level": level,
        "software": header.software or f"ncsim-core {_own_version()}",
        "scenario": header.scenario,
        "scenario_sha256": header.scenario_sha256,
        "seed": header.seed,
        "plugins": {kind: _plugin_entry(identities[kind]) for kind in sorted(identities)},
        "sections": _key_sorted(header.sections),
        "nodes": node_rows(setup.network),
        "links": link_rows(setup.network),
        "kinds": kinds_documented(),
    }


@cache
def _own_version() -> str:
    return version("ncsim-core")


def _plugin_entry(identity: ComponentIdentity) -> dict[str, object]:
    return {
        "name": identity.name,
        "distribution": identity.distribution,
        "version": identity.version,
        "factory": identity.factory,
        "options": _key_sorted(identity.options),
    }


def _key_sorted(mapping: Mapping[str, object]) -> object:
    return json.loads(json.dumps(dict(mapping), sort_keys=True, allow_nan=False))
