"""Follows a trace while it is written: whole records, each once, whatever happens in between.

A place in a trace is a byte offset and a checksum of the bytes before it, so that a place in
another trace is told from one in this. A run that ends moves its folder; the trace stays the same
file.
"""

import gzip
import json
import os
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Final, NamedTuple, Self, TypeAlias, cast

from ncsim_core.trace.reader import GZIP_MAGIC
from typing_extensions import override

CHUNK_BYTES: Final = 256 * 1024
CHECKED_BYTES: Final = 1024
LATEST_BYTES: Final = 1024 * 1024
"""Room for the last record, which may list what did not arrive."""
DONE: Final = b'"k":"done"'


class Mark(NamedTuple):
    """A place between two records of a trace.

    Args:
        offset: Bytes before it.
        check: Checksum of the last of them.
    """

    offset: int
    check: int

    @override
    def __str__(self) -> str:
        return f"{self.offset}-{self.check:08x}"

    @classmethod
    def parse(cls, text: str) -> "Mark | None":
        """Return the place that a text names, ``None`` if it names none."""
        offset, _, check = text.partition("-")
        try:
            return cls(int(offset), int(check, 16)) if offset.isascii() else None
        except ValueError:
            return None


START: Final = Mark(0, 0)


@dataclass(frozen=True)
class Records:
    """Whole lines, and the place after them."""

    lines: bytes
    after: Mark


@dataclass(frozen=True)
class Restart:
    """The trace is another one; it follows from its start."""


@dataclass(frozen=True)
class Idle:
    """There is nothing new yet."""


@dataclass(frozen=True)
class End:
    """Nothing will follow.

    Args:
        status: How the run ended, ``truncated``, ``abandoned``, or ``gone``.
    """

    status: str


Step: TypeAlias = Records | Restart | Idle | End


@dataclass(frozen=True)
class Source:
    """Where a trace is at this moment.

    Args:
        path: The file.
        is_growing: Whether its process lives.
        fate: How it ends if no process is left and it has no last record.
    """

    path: Path
    is_growing: bool
    fate: str = "truncated"


Locate: TypeAlias = Callable[[], Source | None]


def follow(locate: Locate, after: Mark = START) -> Iterator[Step]:
    """Yield the records of a trace from a place on; ``Idle`` when the caller may rest.

    Args:
        locate: Says where the trace is now; ``None`` if it is gone.
        after: Where to go on, as an earlier ``Records`` had it.
    """
    mark = after
    while True:
        source = locate()
        if source is None:
            yield End("gone")
            return
        try:
            reading = _Reading(source.path)
        except FileNotFoundError:  # not there yet, or it has just got its final name
            yield Idle()
            continue
        with reading:
            if not reading.resume(mark):
                yield Restart()
                reading.resume(START)
            for step in _steps(reading, locate):
                yield step
                if isinstance(step, End):
                    return
            mark = reading.mark


def last_record(path: Path) -> Mapping[str, object] | None:
    """Return the record that ends a trace, ``None`` if it has none; reads without parsing."""
    last = b""
    for step in follow(lambda: Source(path, is_growing=False)):
        last = step.lines if isinstance(step, Records) else last
    return _done_in(last)


def _steps(reading: "_Reading", locate: Locate) -> Iterator[Step]:
    """Yield what one file holds; stops without an ``End`` when another has taken its place."""
    while True:
        source = locate()  # before reading: what was written by then is read below
        lines = reading.lines()
        if lines:
            yield Records(lines, reading.mark)
            status = _status_in(lines)
            if status is not None:
                yield End(status)
                return
        elif source is None:
            yield End("gone")
            return
        elif not reading.is_of(source.path):
            return
        elif not source.is_growing:
            yield End(_status_in(reading.latest()) or source.fate)
            return
        else:
            yield Idle()


class _Reading:
    """An open trace, read by whole lines."""

    def __init__(self, path: Path) -> None:
        self._file = _opened(path)
        self._offset = 0
        self._before = b""
        self._torn = b""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    @property
    def mark(self) -> Mark:
        """Return the place after the lines that were read."""
        return Mark(self._offset, zlib.crc32(self._before))

    def resume(self, mark: Mark) -> bool:
        """Go to a place; ``False`` if it is not of this trace."""
        start = max(0, mark.offset - CHECKED_BYTES)
        self._file.seek(start)
        before = self._read(mark.offset - start)
        if len(before) != mark.offset - start or zlib.crc32(before) != mark.check:
            return False
        self._offset, self._before, self._torn = mark.offset, before, b""
        return True

    def lines(self) -> bytes:
        """Return the whole lines among the next bytes; nothing if there are none yet."""
        while chunk := self._read(CHUNK_BYTES):
            whole, newline, self._torn = (self._torn + chunk).rpartition(b"\n")
            if newline:
                lines = whole + newline
                self._offset += len(lines)
                self._before = (self._before + lines)[-CHECKED_BYTES:]
                return lines
        return b""

    def latest(self) -> bytes:
        """Return the last lines that were read, now or before the place it began at."""
        start = max(0, self._offset - LATEST_BYTES)
        self._file.seek(start)
        return self._read(self._offset - start)

    def is_of(self, path: Path) -> bool:
        """Return whether ``path`` still leads to this file."""
        try:
            return os.path.samestat(os.fstat(self._file.fileno()), path.stat())
        except FileNotFoundError:
            return False

    def _read(self, size: int) -> bytes:
        try:
            return self._file.read(size)
        except (EOFError, zlib.error, gzip.BadGzipFile):  # compressed data that stops early
            return b""


def _opened(path: Path) -> BinaryIO:
    file = path.open("rb")
    if file.read(len(GZIP_MAGIC)) != GZIP_MAGIC:
        return file
    file.close()
    return cast("BinaryIO", gzip.open(path, "rb"))


def _status_in(lines: bytes) -> str | None:
    """Return how the run ended if the last line says so."""
    done = _done_in(lines)
    return None if done is None else str(done.get("status", "truncated"))


def _done_in(lines: bytes) -> Mapping[str, object] | None:
    """Return the last line if it is the record that ends a trace."""
    last = lines[lines.rfind(b"\n", 0, -1) + 1 :]
    if DONE not in last:
        return None
    try:
        record = json.loads(last)
    except ValueError:
        return None
    return record if isinstance(record, dict) else None
