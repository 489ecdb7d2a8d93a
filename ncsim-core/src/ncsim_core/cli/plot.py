"""``ncsim plot``: figures of a study."""

from pathlib import Path
from typing import Annotated

import typer


def plot(
    study: Annotated[Path, typer.Argument(metavar="STUDY", help="Folder of a sweep.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Picture: .svg, .pdf or .png.")],
    *,
    along: Annotated[
        str | None, typer.Option(help="Column of the x axis; without it, regret bars.")
    ] = None,
    measure: Annotated[str, typer.Option(help="What is drawn along it.")] = "makespan_s",
    policy: Annotated[str, typer.Option(help="Column of the policies.")] = "scheduler",
    mode: Annotated[str, typer.Option(help="Column that tells Solo from Full.")] = "interference",
) -> None:
    """Draw means with intervals along a column, or the regret of choosing policies by Solo.

    Example: ncsim plot study/ --along payload_MB -o slowdown.svg
    """
    from ncsim_core.sweep.figures import draw_means, draw_regret
    from ncsim_core.sweep.store import Store
    from ncsim_core.sweep.table import table_of

    with Store(study, must_exist=True) as store:
        runs = table_of(store)
    if along is None:
        draw_regret(runs, policy, mode, output)
    else:
        draw_means(runs, along, measure, output)
    typer.echo(f"wrote {output}", err=True)
