"""Figures of single runs, which packages offer: found by name, imported only when drawn."""

from importlib.metadata import entry_points
from pathlib import Path

from ncsim_core.cli.runs import run_of
from ncsim_core.errors import ScenarioError
from ncsim_core.plugins import RUN_FIGURE_GROUP


def draw_run(run: str, kind: str | None, output: Path) -> None:
    """Draw a run as a package knows how to.

    Args:
        run: As verbs take it.
        kind: Name of the figure.
        output: Picture to write.

    Raises:
        ScenarioError: No package offers that kind, or none was named.
    """
    offers = {each.name: each for each in entry_points(group=RUN_FIGURE_GROUP)}
    if kind not in offers:
        known = ", ".join(sorted(offers)) or "none, as ncsim-viz is not installed"
        found = f"{run}: no study; give --kind" if kind is None else f"--kind {kind!r}: unknown"
        raise ScenarioError(f"{found}; figures of runs: {known}")
    offers[kind].load()(run_of(run), output)
