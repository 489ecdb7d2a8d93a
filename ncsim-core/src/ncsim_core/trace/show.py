"""Prints a trace for people: one line per record, with names instead of numbers."""

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from ncsim_core.trace.fields import RECORDS
from ncsim_core.trace.loading import rate_steps
from ncsim_core.trace.reader import read_trace
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
    TracePreamble,
    TraceRecord,
    TransferEnded,
    TransferStarted,
)
from ncsim_core.trace.run_trace import RateStep
from ncsim_core.units import s_from_us

_KIND_OF = {spec.type: kind for kind, spec in RECORDS.items()}


def readable_lines(path: Path | str, kinds: Collection[str] = ()) -> Iterator[str]:
    """Yield a trace as readable lines, the header first.

    Args:
        path: Trace, or the folder of a run.
        kinds: Kinds of record to show; empty for the header and all of them.

    Raises:
        TraceError: It is no trace, or stops being one, or there is no such kind.
    """
    unknown = sorted(set(kinds) - RECORDS.keys())
    if unknown:
        raise TraceError(f"no kind of record {', '.join(unknown)}; there are {', '.join(RECORDS)}")
    with read_trace(path) as reader:
        if not kinds:
            yield from _header_lines(reader.preamble)
        names = _Names(reader.preamble)
        for record in reader:
            if isinstance(record, Injected):
                names.learn(record)
            kind = _KIND_OF[type(record)]
            if not kinds or kind in kinds:
                yield f"{s_from_us(record.at_us):14.6f} s  {kind:<7} {_told(record, names)}"
        if reader.is_truncated:
            yield "(truncated: the trace ends here without a done record)"


def _header_lines(preamble: TracePreamble) -> Iterator[str]:
    header = preamble.header
    size = f"{len(preamble.nodes)} nodes, {len(preamble.links)} links"
    yield f"{header.scenario or 'unnamed scenario'}: seed {header.seed}, {size}, {header.software}"
    for identity in preamble.plugins.values():
        options = ", ".join(f"{key}={value}" for key, value in identity.options.items())
        yield f"  {identity}{': ' if options else ''}{options}"


class _Names:
    """The names behind the numbers, as far as the trace has introduced them."""

    def __init__(self, preamble: TracePreamble) -> None:
        self._nodes = [node.id for node in preamble.nodes]
        self._links = [link.id for link in preamble.links]
        self._tasks: list[tuple[str, str]] = []
        self._edges: list[tuple[int, int]] = []
        self._dags: list[Injected] = []

    def learn(self, record: Injected) -> None:
        self._tasks += [(record.dag_id, task_id) for task_id, _ in record.tasks]
        self._edges += [
            (source, target)
            for source, target, _ in record.edges
            if max(source, target) < len(self._tasks)
        ]
        self._dags.append(record)

    def node(self, number: int) -> str:
        return _entry(self._nodes, number)

    def link(self, number: int) -> str:
        return _entry(self._links, number)

    def task(self, number: int) -> str:
        return "/".join(self._tasks[number]) if number < len(self._tasks) else f"#{number}"

    def transfer(self, number: int) -> str:
        if number >= len(self._edges):
            return f"#{number}"
        source, target = self._edges[number]
        return f"{self.task(source)} -> {self._tasks[target][1]}"

    def placement(self, record: Placed) -> str:
        if record.dag >= len(self._dags):
            return f"DAG #{record.dag}"
        tasks = [task_id for task_id, _ in self._dags[record.dag].tasks]
        pairs = zip(tasks, record.nodes, strict=False)
        return ", ".join(f"{task} on {self.node(node)}" for task, node in pairs)


def _entry(names: Sequence[str], number: int) -> str:
    return names[number] if number < len(names) else f"#{number}"


def _told(record: TraceRecord, names: _Names) -> str:
    match record:
        case Injected():
            return f"{record.dag_id}: {len(record.tasks)} tasks, {len(record.edges)} edges"
        case Placed():
            return names.placement(record)
        case Ready() | Started() | Ended():
            return f"{names.task(record.task)} on {names.node(record.node)}"
        case TransferStarted() | TransferEnded() | RatesAssigned():
            return _transfer_told(record, names)
        case Note():
            return f"{record.namespace}: {record.data!r}"
        case Done():
            return _end_told(record)


def _transfer_told(record: TransferStarted | TransferEnded | RatesAssigned, names: _Names) -> str:
    match record:
        case TransferStarted(_, _, transfer, route, size_MB):
            links = ", ".join(map(names.link, route))
            return f"{names.transfer(transfer)}: {size_MB:g} MB over {links}"
        case TransferEnded(_, _, transfer):
            return names.transfer(transfer)
        case RatesAssigned():
            change, cause = record.cause
            word = "start" if change == "s" else "end"
            rates = "; ".join(_rate_told(*pair, names) for pair in rate_steps(record))
            return f"by {word} of {names.transfer(cause)}: {rates}"


def _rate_told(transfer: int, step: RateStep, names: _Names) -> str:
    why = [f"{step.flows} flows"] if step.flows > 1 else []
    why += [f"{step.contenders} contenders"] if step.contenders else []
    why += [f"{step.hidden_interferers} hidden"] if step.hidden_interferers else []
    against = f" ({', '.join(why)})" if why else ""
    rate = "paused" if step.rate_MBps == 0 else f"{step.rate_MBps:.6g} MB/s"
    return f"{names.transfer(transfer)} {rate} at {names.link(step.bottleneck)}{against}"


def _end_told(record: Done) -> str:
    makespan = (
        "no makespan"
        if record.makespan_us is None
        else f"makespan {s_from_us(record.makespan_us):.6f} s"
    )
    detail = f": {record.detail}" if record.detail else ""
    return f"{record.status}, {makespan}, {record.events} events{detail}"
