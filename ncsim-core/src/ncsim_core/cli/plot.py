"""``ncsim plot``: figures of a study or of a run."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from ncsim_core.cli.studies import (
    FullMode,
    Measure,
    ModeColumn,
    PolicyColumn,
    StudyFolder,
    runs_of,
)
from ncsim_core.errors import ScenarioError


class FigureKind(StrEnum):
    """Which figure."""

    MEANS = "means"
    SLOWDOWN = "slowdown"
    REGRET = "regret"


def plot(  # noqa: PLR0913 - one parameter per option
    study: StudyFolder,
    output: Annotated[Path, typer.Option("--output", "-o", help="Picture: .svg, .pdf or .png.")],
    *,
    kind: Annotated[
        str | None,
        typer.Option(help="Figure of a run: gantt, rates, topology, dag, or one of a package."),
    ] = None,
    figure: Annotated[
        FigureKind | None,
        typer.Option(
            help="means: a measure along a column; slowdown: Full over Solo along it; regret: a "
            "bar per case, inversions in red. By default means with --along, else regret.",
        ),
    ] = None,
    along: Annotated[str | None, typer.Option(help="Column of the x axis.")] = None,
    measure: Measure = "makespan_s",
    policy: PolicyColumn = "scheduler",
    mode: ModeColumn = "interference",
    full: FullMode = None,
) -> None:
    """Draw means or slowdowns of a study along a column, or regret by case; or draw a run.

    Example: ncsim plot study/ --figure slowdown --along payload_MB -o slowdown.svg

    Example: ncsim plot out/ --kind gantt -o gantt.pdf
    """
    from ncsim_core.sweep.figures import draw_means, draw_regret, draw_slowdown
    from ncsim_core.sweep.store import STORE_NAME

    if kind is not None or (study.exists() and not (study / STORE_NAME).exists()):
        from ncsim_core.cli.run_figures import draw_run

        draw_run(str(study), kind, output)
        typer.echo(f"wrote {output}", err=True)
        return
    runs = runs_of(study)
    chosen = figure or (FigureKind.REGRET if along is None else FigureKind.MEANS)
    if chosen is FigureKind.REGRET:
        draw_regret(runs, policy, mode, output, full)
    elif along is None:
        raise ScenarioError(f"--figure {chosen} needs --along COLUMN, the column of its x axis")
    elif chosen is FigureKind.MEANS:
        draw_means(runs, along, measure, output)
    else:
        draw_slowdown(runs, along, mode, output, full)
    typer.echo(f"wrote {output}", err=True)
