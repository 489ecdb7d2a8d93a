"""Verifies a trace against what every run must obey, in one pass and without the engine.

Checked: time never decreases; a task is placed, ready, started and ended once and in this order,
on its node, alone there, for the rounded cost over capacity, as soon as its last input arrived; a
transfer follows its producer's end and latency on a chain of links between its tasks' nodes; the
integral of its rates is its size; no link carries more than its bandwidth; each rate change has its
cause; the ``done`` record counts right and closes a run with nothing left.
"""

from collections import Counter
from pathlib import Path
from typing import NamedTuple

from ncsim_core.engine.outcome import RunStatus
from ncsim_core.trace.fields import RECORDS
from ncsim_core.trace.loading import Introduced, expect_introduced
from ncsim_core.trace.reader import TraceReader, read_trace
from ncsim_core.trace.records import (
    Done,
    Ended,
    Injected,
    Note,
    Placed,
    RatesAssigned,
    Ready,
    Started,
    TraceError,
    TraceRecord,
    TransferEnded,
    TransferStarted,
)
from ncsim_core.trace.task_ledger import TaskLedger
from ncsim_core.trace.transfer_ledger import TransferLedger

MAX_FINDINGS = 1000

_KIND_OF = {spec.type: kind for kind, spec in RECORDS.items()}


class Finding(NamedTuple):
    """Something in a trace that cannot be.

    Args:
        line: Line of the record that shows it.
        message: What is wrong.
    """

    line: int
    message: str


class TraceReport(NamedTuple):
    """What the check of a trace came to.

    Args:
        path: The file.
        status: How the run ended; ``truncated`` if the trace does not say.
        records: Records of known kinds.
        findings: What is wrong; empty if nothing is.
    """

    path: Path
    status: str
    records: int
    findings: tuple[Finding, ...]


def check_trace(path: Path | str) -> list[Finding]:
    """Return what is wrong with a trace, or with the trace in a run's folder.

    Raises:
        TraceError: It cannot be opened or is no trace of a known version.
    """
    return list(trace_report(path).findings)


def trace_report(path: Path | str) -> TraceReport:
    """Check a trace; arguments and errors as for ``check_trace``."""
    with read_trace(path) as reader:
        checker = _Checker(reader)
        return checker.report()


class _Checker:
    def __init__(self, reader: TraceReader) -> None:
        self._reader = reader
        self._findings: list[Finding] = []
        self._line = 1
        self._now_us = 0
        self._counts: Counter[str] = Counter()
        self._dags: list[Injected] = []
        self._status = "truncated"
        preamble = reader.preamble
        self._tasks = TaskLedger(preamble, self._find)
        self._transfers = TransferLedger(preamble, self._tasks, self._find)

    def report(self) -> TraceReport:
        try:
            for record in self._reader:
                self._check(record)
                if len(self._findings) >= MAX_FINDINGS:
                    break
        except TraceError as error:
            place = f"{self._reader.path}:"
            self._find(str(error).removeprefix(place).lstrip("0123456789: "))
        else:
            if self._reader.is_truncated and len(self._findings) < MAX_FINDINGS:
                self._find("the trace is truncated: it has no done record")
        records = sum(self._counts.values())
        return TraceReport(self._reader.path, self._status, records, tuple(self._findings))

    def _find(self, message: str) -> None:
        self._findings.append(Finding(self._line, message))

    def _check(self, record: TraceRecord) -> None:
        self._line = record.line
        if record.at_us < self._now_us:
            self._find(f"time went back from {self._now_us} to {record.at_us} us")
        self._now_us = record.at_us
        try:
            expect_introduced(record, self._introduced)
        except ValueError as error:
            self._find(str(error))
            return
        self._dispatch(record)
        self._counts[_KIND_OF[type(record)]] += 1

    @property
    def _introduced(self) -> Introduced:
        preamble = self._reader.preamble
        return Introduced(
            len(preamble.nodes),
            len(preamble.links),
            len(self._dags),
            len(self._tasks.entries),
            len(self._transfers.entries),
        )

    def _dispatch(self, record: TraceRecord) -> None:
        match record:
            case Injected():
                self._inject(record)
            case Placed():
                self._tasks.place(record, self._dags[record.dag])
            case Ready() | Started() | Ended():
                self._follow_task(record)
            case TransferStarted() | TransferEnded() | RatesAssigned():
                self._follow_transfer(record)
            case Note():
                pass
            case Done():
                self._done(record)

    def _follow_task(self, record: Ready | Started | Ended) -> None:
        match record:
            case Ready():
                self._tasks.ready(record)
            case Started():
                self._tasks.start(record)
            case Ended():
                self._tasks.end(record)
                self._transfers.deliver_locally(record)

    def _follow_transfer(self, record: TransferStarted | TransferEnded | RatesAssigned) -> None:
        match record:
            case TransferStarted():
                self._transfers.start(record)
            case TransferEnded():
                self._transfers.end(record)
            case RatesAssigned():
                self._transfers.assign(record)

    def _inject(self, record: Injected) -> None:
        expected = (len(self._dags), len(self._tasks.entries), len(self._transfers.entries))
        found = (record.dag, record.first_task, record.first_edge)
        if found != expected:
            self._find(f"DAG, first task and first edge are numbered {found}, not {expected}")
        self._dags.append(record)
        self._tasks.inject(record)
        self._transfers.inject(record)

    def _done(self, record: Done) -> None:
        self._status = record.status
        if record.counts != dict(self._counts):
            self._find(f"done counts {record.counts}, the trace has {dict(self._counts)}")
        if record.status != RunStatus.COMPLETED:
            if record.makespan_us is not None:
                self._find(f"a run that ended {record.status} has no makespan")
            return
        self._tasks.expect_all_ended()
        self._transfers.expect_all_ended()
        if record.makespan_us != self._tasks.last_end_us:
            self._find(
                f"the makespan is {record.makespan_us} us, but the last task ended at "
                f"{self._tasks.last_end_us} us"
            )
