"""Reads traces as a stream; whatever is wrong is said with file and line.

Unknown kinds and fields are ignored, as a later minor version may bring them; another major
version is refused. A file that stops before its ``done`` record, even within a line or within
compressed data, is *truncated*: it still opens, and says so when it has been read.
"""

import gzip
import json
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Final, Self, cast

from ncsim_core.trace.fields import RECORDS
from ncsim_core.trace.files import trace_file
from ncsim_core.trace.preamble import preamble_of
from ncsim_core.trace.records import Done, RatesAssigned, TraceError, TracePreamble, TraceRecord
from ncsim_core.trace.shapes import is_count, shown

MAX_LINE_BYTES: Final = 64 * 1024 * 1024
GZIP_MAGIC: Final = b"\x1f\x8b"
ZSTD_MAGIC: Final = b"\x28\xb5\x2f\xfd"

_UNUSABLE = (ValueError, RecursionError)  # all that json.loads can raise


def read_trace(path: Path | str) -> "TraceReader":
    """Open a trace, or the trace in a run's folder, and read its header.

    Raises:
        TraceError: It cannot be opened, is no trace, or is of another major version.
    """
    return TraceReader(trace_file(Path(path)))


class TraceReader:
    """The header of a trace, and its records one by one.

    Iterate once. Afterwards ``is_truncated`` tells whether the ``done`` record was missing.

    Args:
        path: File to read; ``.gz`` is told by its contents.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.is_truncated = True
        self._line = 0
        self._stream = opened(path)
        try:
            self.preamble = self._read_preamble()
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        error_type: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

    def __iter__(self) -> Iterator[TraceRecord]:
        """Yield the records of known kinds, in order.

        Raises:
            TraceError: A record is not what the format says.
        """
        try:
            while (entry := self._next_object()) is not None:
                record = self._record(entry)
                if record is None:
                    continue
                yield record
                if isinstance(record, Done):
                    self._expect_the_end()
                    self.is_truncated = False
                    return
        finally:
            self.close()

    def fault(self, message: str, line: int | None = None) -> TraceError:
        """Return an error that names file and line."""
        return TraceError(f"{self.path}:{line or self._line}: {message}")

    def _advice(self) -> str:
        is_yaml = self.path.suffix.lower() in (".yaml", ".yml")
        return f"; a trace is what ncsim run {self.path.name} -o out/ leaves" if is_yaml else ""

    def _next_object(self) -> Mapping[str, object] | None:
        """Return the next line as an object; ``None`` at the end, whole or torn off."""
        text = self._next_line()
        if not text:
            return None
        try:
            entry = json.loads(text, parse_constant=_refuse_constant)
        except _UNUSABLE as error:
            if not text.endswith(b"\n"):
                return None
            raise self.fault(f"this is no JSON: {shown(text)}{self._advice()}") from error
        if not isinstance(entry, dict):
            raise self.fault(f"expected an object, found {shown(text)}")
        return entry

    def _next_line(self) -> bytes:
        self._line += 1
        try:
            text = self._stream.readline(MAX_LINE_BYTES)
        except EOFError:  # compressed data that stops early
            return b""
        except (OSError, zlib.error) as error:
            raise self.fault(f"cannot be read: {error}") from error
        if len(text) == MAX_LINE_BYTES:
            raise self.fault(f"this line is longer than {MAX_LINE_BYTES} bytes; no trace is")
        return text

    def _record(self, entry: Mapping[str, object]) -> TraceRecord | None:
        kind = entry.get("k")
        at_us = entry.get("t")
        if not isinstance(kind, str):
            raise self.fault(f'"k" must name the kind of record, not {shown(kind)}')
        if not is_count(at_us):
            raise self.fault(f'{kind}: "t" must be whole microseconds, not {shown(at_us)}')
        spec = RECORDS.get(kind)
        if spec is None:
            return None
        values = []
        for key, shape, _ in spec.fields:
            if key not in entry:
                raise self.fault(f'{kind}: "{key}" is missing')
            value = entry[key]
            if not shape.accepts(value):
                raise self.fault(f'{kind}: "{key}" must be {shape.says}, not {shown(value)}')
            values.append(value)
        record = spec.type(self._line, at_us, *values)  # type: ignore[arg-type] # shapes were checked
        if isinstance(record, RatesAssigned):
            self._expect_parallel_lists(record)
        return record

    def _expect_parallel_lists(self, record: RatesAssigned) -> None:
        lists = cast("list[list[float]]", record[3:])
        if any(len(each) != len(record.transfers) for each in lists):
            lengths = ", ".join(str(len(each)) for each in lists)
            raise self.fault(f"recalc: its lists must be equally long, not {lengths}")

    def _expect_the_end(self) -> None:
        if self._next_line().strip():
            raise self.fault("nothing may follow the done record")

    def _read_preamble(self) -> TracePreamble:
        entry = self._next_object()
        if entry is None:
            raise self.fault("the file is empty or its header is torn off; no trace")
        return preamble_of(entry, self.fault)


def opened(path: Path) -> BinaryIO:
    """Return a trace as a stream of bytes, decompressed.

    Raises:
        TraceError: It cannot be read, or is compressed with zstd.
    """
    try:
        raw = path.open("rb")
        magic = raw.read(4)
        raw.seek(0)
    except OSError as error:
        raise TraceError(f"{path}: cannot be read: {error.strerror or error}") from error
    if magic.startswith(GZIP_MAGIC):
        raw.close()
        return cast("BinaryIO", gzip.open(path, "rb"))
    if magic == ZSTD_MAGIC:
        raw.close()
        raise TraceError(f"{path}: is zstd-compressed; decompress it first: zstd -d {path}")
    return raw


def _refuse_constant(name: str) -> object:
    raise ValueError(f"{name} is no JSON number")
