"""Runs in a notebook: the report where scripts may run, a picture where not, text elsewhere.

>>> from ncsim_viz import show
>>> show("out/")  # doctest: +SKIP
"""

from collections.abc import Container
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from ncsim_core.api import RunResult, overridden, prepare
from ncsim_core.scenario.model import Scenario
from ncsim_core.trace.loading import load_run
from ncsim_core.trace.output import SCENARIO_NAME
from ncsim_core.trace.records import TraceHeader
from ncsim_core.trace.writer import TraceWriter

from ncsim_viz.document import report_html
from ncsim_viz.gantt import Chart, chart_of_result, chart_of_run
from ncsim_viz.svg import svg_gantt
from ncsim_viz.terminal import TerminalSize, drawn

HEIGHT_px: Final = 640
TEXT_SIZE: Final = TerminalSize(columns=100, has_blocks=True)


class RunView:
    """A run as a notebook shows it.

    Args:
        chart: Its Gantt chart.
        report: Its report; empty for a mere result, which has no rates to show.
    """

    def __init__(self, chart: Chart, report: str = "") -> None:
        self.chart = chart
        self.report = report

    def _repr_mimebundle_(
        self, include: Container[str] | None = None, exclude: Container[str] | None = None
    ) -> dict[str, str]:
        """Return the run in each form that a front end may choose from."""
        forms = {"text/plain": drawn(self.chart, TEXT_SIZE), "image/svg+xml": svg_gantt(self.chart)}
        if self.report:
            forms["text/html"] = self.html()
        return {
            kind: text
            for kind, text in forms.items()
            if (include is None or kind in include) and kind not in (exclude or ())
        }

    def html(self) -> str:
        """Return the report in a frame of its own, which cannot touch the notebook."""
        return (
            f'<iframe sandbox="allow-scripts allow-downloads" srcdoc="{escape(self.report)}" '
            f'style="width:100%;height:{HEIGHT_px}px;border:1px solid #ccc" '
            f'title="{escape(self.chart.title)}"></iframe>'
        )


def show(run: RunResult | Scenario | Path | str, **overrides: object) -> RunView:
    """Return a run for a notebook to show.

    Args:
        run: Folder of a run or its trace file; a scenario, which is run; or a result, of which
            there is a picture and a text, but no report.
        **overrides: Values under ``config`` of a scenario, as ``simulate`` takes them.

    Raises:
        TraceError: There is no trace.
        ScenarioError: The scenario or an override is wrong.
    """
    if isinstance(run, RunResult):
        return RunView(chart_of_result(run))
    if isinstance(run, Scenario):
        return _simulated(overridden(run, overrides))
    path = Path(run)
    return RunView(chart_of_run(load_run(path)), report_html(path))


def _simulated(scenario: Scenario) -> RunView:
    with TemporaryDirectory(prefix="ncsim-show-") as name:
        folder = Path(name)
        writer = TraceWriter(folder / "trace.jsonl", TraceHeader.of(scenario))
        prepare(scenario, observers=[writer]).run()
        (folder / SCENARIO_NAME).write_text(scenario.to_yaml(), encoding="utf-8")
        return show(folder)
