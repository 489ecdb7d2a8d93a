"""``ncsim plot``: figures of a study."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from ncsim_core.errors import ScenarioError


class FigureKind(StrEnum):
    """Which figure."""

    MEANS = "means"
    SLOWDOWN = "slowdown"
    REGRET = "regret"


def plot(  # noqa: PLR0913 - one parameter per option
    study: Annotated[Path, typer.Argument(metavar="STUDY", help="Folder of a sweep.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Picture: .svg, .pdf or .png.")],
    *,
    figure: Annotated[
        FigureKind | None,
        typer.Option(
            help="means: a measure along a column; slowdown: Full over Solo along it; regret: a "
            "bar per case, inversions in red. By default means with --along, else regret.",
        ),
    ] = None,
    along: Annotated[str | None, typer.Option(help="Column of the x axis.")] = None,
    measure: Annotated[str, typer.Option(help="What is drawn along it.")] = "makespan_s",
    policy: Annotated[
        str, typer.Option(help="Column of the policies to choose from.")
    ] = "scheduler",
    mode: Annotated[
        str, typer.Option(help="Column that tells Solo (none) from Full.")
    ] = "interference",
) -> None:
    """Draw means or slowdowns with intervals along a column, or regret by case.

    Example: ncsim plot study/ --figure slowdown --along payload_MB -o slowdown.svg
    """
    from ncsim_core.sweep.figures import draw_means, draw_regret, draw_slowdown
    from ncsim_core.sweep.store import Store
    from ncsim_core.sweep.table import table_of

    with Store(study, must_exist=True) as store:
        runs = table_of(store)
    kind = figure or (FigureKind.REGRET if along is None else FigureKind.MEANS)
    if kind is FigureKind.REGRET:
        draw_regret(runs, policy, mode, output)
    elif along is None:
        raise ScenarioError(f"--figure {kind} needs --along COLUMN, the column of its x axis")
    elif kind is FigureKind.MEANS:
        draw_means(runs, along, measure, output)
    else:
        draw_slowdown(runs, along, mode, output)
    typer.echo(f"wrote {output}", err=True)
