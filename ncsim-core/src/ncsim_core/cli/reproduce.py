"""``ncsim reproduce``: does a folder that somebody sent hold what its scenario gives?"""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ncsim_core.cli.exit_codes import ExitCode

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ncsim_core.cli.reproducing import Reproduction


def reproduce(
    run: Annotated[
        str,
        typer.Argument(
            metavar="RUN",
            help="Output folder of a run, or STUDY@COLUMN=VALUE,... for one of a study.",
        ),
    ],
) -> None:
    """Run the scenario of a run's folder again and compare traces, byte for byte, and metrics.

    If they differ, it says where they part first, which packages are of another version, and
    whether scenario or metrics were changed; it leaves with exit code 1. A study keeps no traces:
    the makespan of a run of it is compared.

    Example: ncsim reproduce out/
    """
    from ncsim_core.cli.reproducing import reproduction_of

    if "@" in run and not Path(run).exists():
        typer.echo(_of_study(run))
        return
    folder = Path(run)
    reproduction = reproduction_of(folder)
    for line in _lines(folder, reproduction):
        typer.echo(line)
    if reproduction.faults:
        raise typer.Exit(ExitCode.INVALID_INPUT)


def _of_study(text: str) -> str:
    """Return that a run of a study came out as the study says; anything else is an error."""
    from ncsim_core.cli.runs import run_of

    end = run_of(text).end
    makespan = "" if end.makespan_us is None else f", makespan {end.makespan_us / 1e6:.6f} s"
    return f"{text}: reproduced; {end.status}{makespan}, as in the study"


def _lines(run: Path, reproduction: "Reproduction") -> "Iterator[str]":
    result = reproduction.result
    makespan = "" if result.makespan_s is None else f", makespan {result.makespan_s:.6f} s"
    verdict = "NOT reproduced" if reproduction.faults else "reproduced"
    how = "the first " if reproduction.faults else ""
    equal = f"{how}{reproduction.records} records are the same"
    yield f"{run}: {verdict}; {equal}; here {result.status}{makespan}"
    yield from (f"  {each}" for each in (*reproduction.versions, *reproduction.faults))
    if reproduction.faults:
        again = run / "scenario.yaml"
        yield f"  all that changed: ncsim run {again} -o again && ncsim compare {run} again"
