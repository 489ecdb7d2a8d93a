"""Files of a run under their final name only when they are whole; plain or compressed."""

import contextlib
import gzip
import json
import os
import secrets
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO, Final, TextIO, cast

from ncsim_core.trace.records import TraceError

GZIP_LEVEL: Final = 6
TRACE_NAMES: Final = ("trace.jsonl", "trace.jsonl.gz")


def temporary_sibling(path: Path) -> Path:
    """Return an unused hidden name beside ``path``, on the same file system."""
    return path.with_name(f".{path.name}.partial-{os.getpid()}-{secrets.token_hex(4)}")


@contextlib.contextmanager
def appearing(path: Path) -> Iterator[Path]:
    """Yield where to write a file that takes the name ``path`` when the block ends well.

    A name that stands for a device or a pipe is written to as it is; a link, where it leads to.

    Raises:
        TraceError: It cannot be written.
    """
    final, place = _places(path)
    try:
        yield place
        if place != final:
            place.replace(final)
    except OSError as error:
        raise TraceError(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        if place != final:
            with contextlib.suppress(OSError):
                place.unlink(missing_ok=True)


def write_atomically(path: Path, content: str | bytes) -> None:
    """Write a file that appears under its name only when it is whole.

    Args:
        path: Its name.
        content: Bytes, or text, which is compressed if the name ends in ``.gz``.

    Raises:
        TraceError: It cannot be written.
    """
    data = content if isinstance(content, bytes) else content.encode("utf-8", "backslashreplace")
    if path.suffix == ".gz" and isinstance(content, str):
        data = gzip.compress(data, GZIP_LEVEL, mtime=0)
    with appearing(path) as place:
        place.write_bytes(data)


def _places(path: Path) -> tuple[Path, Path]:
    """Return where a file is to be in the end, and where it is written until it is whole."""
    if path.exists() and not path.is_file():
        return path, path
    final = path.resolve() if path.is_symlink() else path
    return final, temporary_sibling(final)


def json_text(document: object) -> str:
    """Return a JSON document for people: indented, keys in the order given, line at the end."""
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def trace_file(target: Path) -> Path:
    """Return the trace that a path means: itself, or the one inside a run's folder.

    Raises:
        TraceError: There is none.
    """
    if not target.is_dir():
        return target
    for name in TRACE_NAMES:
        if (target / name).is_file():
            return target / name
    raise TraceError(f"{target}: this folder holds no {' or '.join(TRACE_NAMES)}")


class LineSink:
    """Where lines go: a stream of the caller's, or a file that is renamed when whole.

    Args:
        target: Path (compressed if it ends in ``.gz``) or open text stream.
        is_live: Write under the final name from the start, and to disk at every write.

    Raises:
        TraceError: The file cannot be written.
    """

    def __init__(self, target: Path | str | TextIO, *, is_live: bool = False) -> None:
        self._is_live = is_live
        self._path: Path | None = None
        self._failure = "this file is already closed"
        if not isinstance(target, Path | str):
            self._stream: TextIO | BinaryIO | None = target
            self._put: Callable[[bytes], object] = lambda lines: target.write(lines.decode())
            return
        self._path = Path(target)
        self._final, self._written_to = _places(self._path)
        if is_live:
            self._written_to = self._final
        try:
            self._raw = self._written_to.open("wb")
        except OSError as error:
            raise self._fault(error) from error
        self._stream = self._raw
        if self._path.suffix == ".gz":  # without name and time, equal lines give equal bytes
            self._stream = cast("BinaryIO", gzip.GzipFile("", "wb", GZIP_LEVEL, self._raw, mtime=0))
        self._put = self._stream.write

    def write(self, lines: bytes) -> None:
        """Write lines in UTF-8."""
        if self._stream is None:
            raise TraceError(f"{self._path or 'trace'}: {self._failure}")
        try:
            self._put(lines)
            if self._is_live:
                self._stream.flush()
        except OSError as error:
            self.discard()
            raise self._fault(error) from error

    def finish(self) -> None:
        """Close the file and give it its name; a stream of the caller's is only flushed."""
        stream, self._stream = self._stream, None
        if stream is None:
            return
        try:
            if self._path is None:
                stream.flush()
                return
            stream.close()
            self._raw.close()
            if self._written_to != self._final:
                self._written_to.replace(self._final)
        except OSError as error:
            self._close_raw()
            self._remove()
            raise self._fault(error) from error

    def discard(self) -> None:
        """Remove what was written unless it is finished; a live file stays as it is."""
        stream, self._stream = self._stream, None
        if stream is None or self._path is None:
            return
        with contextlib.suppress(OSError):  # a full disk: what is buffered is not wanted any more
            stream.close()
        self._close_raw()
        self._remove()

    def _close_raw(self) -> None:
        with contextlib.suppress(OSError):
            self._raw.close()

    def _remove(self) -> None:
        if self._written_to != self._final:
            self._written_to.unlink(missing_ok=True)

    def _fault(self, error: OSError) -> TraceError:
        self._failure = f"cannot be written: {error.strerror or error}"
        return TraceError(f"{self._path or 'trace'}: {self._failure}")
