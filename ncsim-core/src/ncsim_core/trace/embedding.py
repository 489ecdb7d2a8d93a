"""Traces inside HTML: a report holds the trace of its run, compressed, and gives it back."""

import base64
import binascii
import gzip
import re
import zlib
from pathlib import Path
from typing import Final

from ncsim_core.trace.files import trace_file
from ncsim_core.trace.reader import GZIP_MAGIC
from ncsim_core.trace.records import TraceError

TRACE_TYPE: Final = "application/x-ncsim-trace"

_ELEMENT = re.compile(rf'<script type="{TRACE_TYPE}">([A-Za-z0-9+/=\s]*)</script>')


def data_element(kind: str, payload: bytes) -> str:
    """Return an HTML element that holds bytes; nothing in them can end it."""
    return f'<script type="{kind}">{base64.b64encode(payload).decode()}</script>'


def compressed_trace(source: Path) -> bytes:
    """Return the bytes of a run's trace, compressed; equal traces give equal bytes.

    Raises:
        TraceError: It cannot be read.
    """
    path = trace_file(source)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise TraceError(f"{path}: cannot be read: {error.strerror or error}") from error
    return content if content.startswith(GZIP_MAGIC) else gzip.compress(content, mtime=0)


def embedded_traces(page: str) -> list[bytes]:
    """Return the traces inside a report, compressed as they were put in.

    Raises:
        TraceError: One is damaged.
    """
    try:
        return [base64.b64decode(each, validate=False) for each in _ELEMENT.findall(page)]
    except binascii.Error as error:
        raise TraceError(f"the trace inside is damaged: {error}") from error


def traces_in(page: str) -> list[bytes]:
    """Return the traces inside a report, uncompressed, byte for byte as the runs wrote them.

    Raises:
        TraceError: One is damaged.
    """
    try:
        return [gzip.decompress(each) for each in embedded_traces(page)]
    except (EOFError, OSError, zlib.error) as error:
        raise TraceError(f"the trace inside is damaged: {error}") from error
