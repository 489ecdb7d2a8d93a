"""One HTML file with a run inside: works from a disk, loads nothing, and is the run's archive."""

import base64
import gzip
import html
import json
import re
from importlib.resources import files
from pathlib import Path
from typing import Final

from ncsim_core.trace.files import trace_file
from ncsim_core.trace.loading import load_run
from ncsim_core.trace.reader import GZIP_MAGIC
from ncsim_core.trace.records import TraceError

from ncsim_viz.extras import comparison_of, extras_of
from ncsim_viz.packing import packed

PLACEHOLDER: Final = "<!--NCSIM-DATA-->"
TRACE_TYPE: Final = "application/x-ncsim-trace"
EXTRAS_TYPE: Final = "application/x-ncsim-extras"
LARGE_BYTES: Final = 25_000_000
"""From about here, mail and browsers make difficulties."""


def report_html(source: Path, other: Path | None = None) -> str:
    """Return a report of a run, or of two with what changed between them.

    Args:
        source: A run's folder, or its trace file.
        other: A second run to compare with.

    Raises:
        TraceError: A trace cannot be read.
    """
    run = load_run(source)
    extras = extras_of(source, run)
    sources = [source]
    if other is not None:
        sources.append(other)
        extras["comparison"] = comparison_of(run, load_run(other), (source.name, other.name))
    payload = gzip.compress(json.dumps(extras, allow_nan=False).encode(), mtime=0)
    elements = [_element(TRACE_TYPE, compressed_trace(each)) for each in sources]
    elements.append(_element(EXTRAS_TYPE, payload))
    page = viewer_html().replace(PLACEHOLDER, "\n".join(elements), 1)
    title = html.escape(run.header.scenario or source.name)
    return packed(page.replace("<title>ncsim viewer</title>", f"<title>{title} - ncsim</title>", 1))


def viewer_html() -> str:
    """Return the built viewer without data."""
    return (files("ncsim_viz") / "viewer.html").read_text(encoding="utf-8")


def compressed_trace(source: Path) -> bytes:
    """Return the bytes of a run's trace, compressed; equal traces give equal bytes."""
    path = trace_file(source)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise TraceError(f"{path}: cannot be read: {error.strerror or error}") from error
    return content if content.startswith(GZIP_MAGIC) else gzip.compress(content, mtime=0)


def traces_in(report: str) -> list[bytes]:
    """Return the traces inside a report, uncompressed, as they were when it was made."""
    pattern = rf'<script type="{TRACE_TYPE}">([A-Za-z0-9+/=]*)</script>'
    return [gzip.decompress(base64.b64decode(each)) for each in re.findall(pattern, report)]


def _element(kind: str, payload: bytes) -> str:
    return f'<script type="{kind}">{base64.b64encode(payload).decode()}</script>'
