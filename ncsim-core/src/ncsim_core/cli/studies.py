"""The runs of a study as verbs take them, with a word on what is not there yet."""

from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from ncsim_core.sweep.table import Table


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
