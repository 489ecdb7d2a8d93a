"""One HTML file with a run or a study inside: works from a disk, loads nothing, is an archive."""

import gzip
import html
import json
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Final

from ncsim_core.trace.embedding import TRACE_TYPE, compressed_trace, data_element
from ncsim_core.trace.loading import load_run

from ncsim_viz.extras import comparison_of, extras_of
from ncsim_viz.packing import packed
from ncsim_viz.study import is_study, study_document

PLACEHOLDER: Final = "<!--NCSIM-DATA-->"
TITLE: Final = "<title>ncsim viewer</title>"
EXTRAS_TYPE: Final = "application/x-ncsim-extras"
LARGE_BYTES: Final = 25_000_000
"""From about here, mail and browsers make difficulties."""


def report_html(source: Path, other: Path | None = None) -> str:
    """Return a report of a run or a study, or of two runs with what changed between them.

    Args:
        source: A run's folder, its trace file, or a study's folder.
        other: A second run to compare with.

    Raises:
        TraceError: A trace cannot be read.
        ScenarioError: A study cannot be read.
    """
    if is_study(source) and other is None:
        study = study_document(source)
        return _page(str(study["name"]), [], {"study": study})
    run = load_run(source)
    extras = extras_of(source, run)
    sources = [source]
    if other is not None:
        sources.append(other)
        extras["comparison"] = comparison_of(run, load_run(other), (source.name, other.name))
    return _page(run.header.scenario or source.name, sources, extras)


def _page(title: str, runs: list[Path], extras: Mapping[str, object]) -> str:
    payload = gzip.compress(json.dumps(extras, allow_nan=False).encode(), mtime=0)
    elements = [data_element(TRACE_TYPE, compressed_trace(each)) for each in runs]
    elements.append(data_element(EXTRAS_TYPE, payload))
    return packed(with_data(elements, title))


def with_data(elements: list[str], title: str) -> str:
    """Return the viewer with data in it.

    Args:
        elements: From ``data_element``.
        title: Of the page.
    """
    page = viewer_html().replace(PLACEHOLDER, "\n".join(elements), 1)
    return page.replace(TITLE, f"<title>{html.escape(title)} - ncsim</title>", 1)


def viewer_html() -> str:
    """Return the built viewer without data."""
    return (files("ncsim_viz") / "viewer.html").read_text(encoding="utf-8")
