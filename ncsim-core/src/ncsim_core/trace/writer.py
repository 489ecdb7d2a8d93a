"""Writes the trace of a run while it goes on, in constant memory.

The frequent kinds are formatted by hand: same text as ``json.dumps`` with compact separators,
at a fraction of the time.
"""

import json
import math
import time
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from importlib.metadata import version
from pathlib import Path
from types import TracebackType
from typing import Final, Self, TextIO, TypeVar

from typing_extensions import override

from ncsim_core.contracts.interference_model import NO_COMPETITION, Competition
from ncsim_core.engine.observer import Observer, RateCause, RateChange, RateColumns
from ncsim_core.engine.outcome import Outcome
from ncsim_core.engine.setup import Setup
from ncsim_core.models import ComponentIdentity
from ncsim_core.network import LinkIndex, NodeIndex, Route
from ncsim_core.trace.fields import RECORDS, kinds_documented
from ncsim_core.trace.files import TextSink
from ncsim_core.trace.records import FORMAT, TIME_UNIT, VERSION, TraceHeader, TraceLevel
from ncsim_core.trace.tables import injected_record, link_rows, node_rows
from ncsim_core.units import Instant

BUFFER_LINES: Final = 1000
"""About 100 KB."""

LONG_LINE_CHARACTERS: Final = 64 * 1024
"""From here on a line, of an injection say, is written at once."""

LIVE_FLUSH_s: Final = 0.25
MAX_TEXTS_KEPT: Final = 10_000

BY: Final = {"start": "s", "finish": "e"}

_T = TypeVar("_T")

to_json: Final[Callable[[object], str]] = json.JSONEncoder(
    separators=(",", ":"), ensure_ascii=False, allow_nan=False
).encode


class _Texts(dict[_T, str]):
    """The text of each value as json writes it, kept because rates, links and routes recur.

    Args:
        text_of: Makes the text of a value.
    """

    def __init__(self, text_of: Callable[[_T], str]) -> None:
        super().__init__()
        self._text_of = text_of

    def __missing__(self, value: _T) -> str:
        text = self._text_of(value)
        if len(self) < MAX_TEXTS_KEPT:
            self[value] = text
        return text


def _float_text(number: float) -> str:
    return float.__repr__(float(number))  # numpy's own subclass would say np.float64(...)


def _alone_text(count: int) -> str:
    """Return what ``count`` bottlenecks are up against that compete with nobody."""
    zeros, ones = ",".join(["0"] * count), ",".join(["1.0"] * count)
    return f'"nc":[{zeros}],"nh":[{zeros}],"fh":[{ones}]'


def _route_text(route: Route) -> str:
    return f"[{','.join(map(str, route))}]"


class TraceWriter(Observer):
    """Observer that writes a trace.

    Give it a path and it writes to a temporary name beside it, compressed if the name ends in
    ``.gz``, and renames when the run has ended; leaving a ``with`` block before that leaves no
    file. Give it an open text stream and it writes there and closes nothing.

    Args:
        target: Path or text stream.
        header: What the trace says about its scenario.
        level: ``full``, or ``coarse`` to leave ``recalc`` records out.
        is_live: Write under the final name at once, the header without delay and the rest at
            least every quarter of a second, for those who follow a run.
    """

    may_lag = True

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
        self._sink = TextSink(target, is_live=is_live)
        self._is_live = is_live
        self._due_s = -math.inf
        self._float_text = _Texts(_float_text).__getitem__
        self._route_text = _Texts(_route_text).__getitem__
        self._number_text = _Texts[int](str).__getitem__
        self._count_text = _Texts[int](str).__getitem__  # of a plug-in: 1 and 1.0 share a text
        self._alone_text = _Texts(_alone_text).__getitem__
        self._lines: list[str] = []
        self._append = self._lines.append
        self._counts = dict.fromkeys(RECORDS, 0)
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
        self._put(to_json(header_document(self._header, self._level, setup)) + "\n")

    @override
    def dag_injected(self, at_us: Instant, dag: int, nodes: Sequence[NodeIndex]) -> None:
        assert self._setup is not None  # the engine starts runs before it injects
        injected = injected_record(self._setup, at_us, dag)
        keys = (field.key for field in RECORDS["inject"].fields)
        self._put_record("inject", at_us, dict(zip(keys, injected[2:], strict=True)))
        self._put_record("place", at_us, {"d": dag, "n": [int(node) for node in nodes]})

    @override
    def task_ready(self, at_us: Instant, task: int, node: NodeIndex) -> None:
        self._counts["ready"] += 1
        self._append(f'{{"t":{at_us},"k":"ready","i":{task},"n":{node}}}\n')

    @override
    def task_started(self, at_us: Instant, task: int, node: NodeIndex) -> None:
        self._counts["start"] += 1
        self._append(f'{{"t":{at_us},"k":"start","i":{task},"n":{node}}}\n')

    @override
    def task_ended(self, at_us: Instant, task: int, node: NodeIndex) -> None:
        self._counts["end"] += 1
        self._append(f'{{"t":{at_us},"k":"end","i":{task},"n":{node}}}\n')
        self._flush_if_due()

    @override
    def transfer_started(
        self, at_us: Instant, transfer: int, route: Sequence[LinkIndex], size_MB: float
    ) -> None:
        self._counts["xstart"] += 1
        links, size = self._route_text(tuple(route)), self._float_text(size_MB)
        self._append(f'{{"t":{at_us},"k":"xstart","x":{transfer},"route":{links},"size":{size}}}\n')

    @override
    def rates_assigned(
        self, at_us: Instant, cause: RateCause, changes: Sequence[RateChange]
    ) -> None:
        if changes:
            transfers, rates_MBps, links, flows, against = zip(*changes, strict=True)
            columns = transfers, rates_MBps, links, flows, against
            self.rate_columns_assigned(at_us, cause, columns)

    @override
    def rate_columns_assigned(self, at_us: Instant, cause: RateCause, columns: RateColumns) -> None:
        if self._level != "full":
            return
        self._counts["recalc"] += 1
        change, number = cause
        transfers, rates_MBps, links, flows, against = columns
        text = self._number_text
        self._append(
            f'{{"t":{at_us},"k":"recalc","by":["{BY[change]}",{number}],'
            f'"x":[{",".join(map(text, transfers))}],'
            f'"r":[{",".join(map(self._float_text, rates_MBps))}],'
            f'"l":[{",".join(map(text, links))}],{self._against_text(against)},'
            f'"f":[{",".join(map(text, flows))}]}}\n'
        )

    def _against_text(self, against: Sequence[Competition]) -> str:
        """Return the three columns of what bottlenecks are up against."""
        if against.count(NO_COMPETITION) == len(against):
            return self._alone_text(len(against))
        text = self._count_text
        contenders, hidden, factors = zip(*against, strict=True)
        return (
            f'"nc":[{",".join(map(text, contenders))}],"nh":[{",".join(map(text, hidden))}],'
            f'"fh":[{",".join(map(self._float_text, factors))}]'
        )

    @override
    def transfer_ended(self, at_us: Instant, transfer: int) -> None:
        self._counts["xend"] += 1
        self._append(f'{{"t":{at_us},"k":"xend","x":{transfer}}}\n')
        self._flush_if_due()

    def note(self, at_us: Instant, namespace: str, data: object) -> None:
        """Put something of a plug-in on record, under the plug-in's name."""
        self._put_record("note", at_us, {"ns": namespace, "data": data})

    @override
    def run_ended(self, outcome: Outcome) -> None:
        counts = {kind: count for kind, count in self._counts.items() if count}
        fields = {
            "status": str(outcome.status),
            "makespan_us": outcome.makespan_us,
            "events": outcome.events,
            "detail": outcome.detail,
            "counts": counts,
        }
        self._put_record("done", outcome.ended_us, fields)
        self._flush()
        self._sink.finish()

    def _put_record(self, kind: str, at_us: Instant, fields: Mapping[str, object]) -> None:
        self._counts[kind] += 1
        self._put(to_json({"t": at_us, "k": kind, **fields}) + "\n")

    def _put(self, line: str) -> None:
        self._lines.append(line)
        if len(line) >= LONG_LINE_CHARACTERS:
            self._flush()
        else:
            self._flush_if_due()

    def _flush_if_due(self) -> None:
        """Write what waits if it is much or somebody follows; called when something has ended."""
        is_full = len(self._lines) >= BUFFER_LINES
        if is_full or (self._is_live and time.monotonic() >= self._due_s):
            self._flush()

    def _flush(self) -> None:
        self._sink.write("".join(self._lines))
        self._lines.clear()
        self._due_s = time.monotonic() + LIVE_FLUSH_s


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
