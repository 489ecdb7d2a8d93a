"""How the figures of studies look: size, colours, markers, files that are equal byte for byte."""

import importlib
import io
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from ncsim_core.errors import ScenarioError
from ncsim_core.trace.files import write_atomically

COLOURS: Final = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
"""Told apart by colour-blind readers too. Source: Okabe and Ito (2008)."""
MARKERS: Final = "osD^vP*"
INVERTED: Final = "#D55E00"
PLAIN: Final = "#7A9EB8"
FORMATS: Final = (".png", ".pdf", ".svg")

_LOOK: Final[Mapping[str, Any]] = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "0.9",
    "pdf.fonttype": 42,  # text stays text; publishers ask for it
    "svg.fonttype": "none",
    "svg.hashsalt": "ncsim",
}
_NO_DATE: Final = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}


@contextmanager
def figure_at(path: Path, width_in: float = 6.0, height_in: float = 3.8) -> Iterator[Any]:
    """Give a matplotlib figure to draw in, and write it to ``path``; its suffix says how.

    Raises:
        ScenarioError: matplotlib is not installed, or the suffix is no picture's.
    """
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise ScenarioError(f"{path}: a figure ends in {', '.join(FORMATS)}")
    try:
        matplotlib: Any = importlib.import_module("matplotlib")
    except ImportError:
        raise ScenarioError("figures need matplotlib: pip install 'ncsim-core[plots]'") from None
    with matplotlib.rc_context(_LOOK):
        figures: Any = importlib.import_module("matplotlib.figure")
        figure = figures.Figure(figsize=(width_in, height_in), layout="constrained")
        yield figure
        path.parent.mkdir(parents=True, exist_ok=True)
        picture = (
            io.BytesIO()
        )  # not the file itself: matplotlib's PDF writer stumbles over full disks
        metadata = _NO_DATE.get(suffix)
        figure.savefig(picture, dpi=200, format=suffix.removeprefix("."), metadata=metadata)
        write_atomically(path, picture.getvalue())


def style(number: int) -> dict[str, Any]:
    """Return how the line of a number looks; two that coincide are both seen."""
    colour = COLOURS[number % len(COLOURS)]
    return {
        "color": colour,
        "marker": MARKERS[number % len(MARKERS)],
        "markerfacecolor": "none",
        "markersize": (8.0, 5.0)[number % 2],
        "linestyle": ("-", "--", "-.", ":")[number % 4],
        "linewidth": (1.8, 1.2)[number % 2],
        "capsize": 3,
    }
