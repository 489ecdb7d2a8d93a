"""The runs of a study as verbs take them, with a word on what is not there yet."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

if TYPE_CHECKING:
    from ncsim_core.sweep.table import Table

StudyFolder: TypeAlias = Annotated[Path, typer.Argument(metavar="STUDY", help="Folder of a sweep.")]
Measure: TypeAlias = Annotated[
    str, typer.Option("--measure", help="Number: makespan_s, wall_s, route_work_MB_hops, ...")
]
PolicyColumn: TypeAlias = Annotated[
    str, typer.Option("--policy", help="Column of the policies to choose from.")
]
ModeColumn: TypeAlias = Annotated[
    str, typer.Option("--mode", help="Column that tells Solo (none) from Full.")
]
FullMode: TypeAlias = Annotated[
    str | None,
    typer.Option("--full", help="Value that means Full, if --mode has several besides none."),
]
Digits: TypeAlias = Annotated[
    int, typer.Option("--digits", min=0, max=12, help="After the point, in tables for people.")
]


def runs_of(study: Path) -> "Table":
    """Return the runs of a study; say on stderr if some are still to be done.

    Raises:
        ScenarioError: It is no study.
    """
    from ncsim_core.sweep.store import Store
    from ncsim_core.sweep.table import table_of

    with Store(study, must_exist=True) as store:
        _, planned = store.current()
        left = planned - sum(store.counts().values())
        runs = table_of(store)
    if left:
        typer.echo(f"note: {left} of {planned} runs of {study} are still to be done", err=True)
    return runs
