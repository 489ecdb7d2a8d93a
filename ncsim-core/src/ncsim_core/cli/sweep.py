"""``ncsim sweep``: many runs from one file; status and merging of studies."""

import json
import sys
from collections import Counter
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import typer

from ncsim_core.cli.exit_codes import ExitCode
from ncsim_core.cli.progress import Pace, ProgressLine
from ncsim_core.errors import ScenarioError

SHOWN_ERRORS = 5
ERROR_WIDTH = 200

if TYPE_CHECKING:
    from ncsim_core.sweep.plan import SweepPlan
    from ncsim_core.sweep.running import SweepOptions, SweepResults


Workers: TypeAlias = Annotated[
    int | None,
    typer.Option("--workers", "-j", min=1, help="Processes; by default one per processor."),
]
ExecutorName: TypeAlias = Annotated[
    str, typer.Option("--executor", help="process, serial, dask, or one that a package offers.")
]
Address: TypeAlias = Annotated[
    str | None, typer.Option("--address", help="Of the Dask scheduler, tcp://...")
]
Shard: TypeAlias = Annotated[
    str | None,
    typer.Option("--shard", metavar="I/N", help="Do part I of N only, for job arrays."),
]
RetryFailed: TypeAlias = Annotated[
    bool, typer.Option("--retry-failed", help="Do runs again that failed or hit a limit.")
]
DryRun: TypeAlias = Annotated[
    bool, typer.Option("--dry-run", help="Check the file and say how many runs it makes.")
]


def sweep(  # noqa: PLR0913 - one parameter per option
    file: Annotated[
        list[str],
        typer.Argument(
            metavar="FILE | status STUDY | merge STUDY FROM...",
            help="Sweep file; or status and a study; or merge, a study and those to add.",
        ),
    ],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the study.")
    ] = None,
    *,
    workers: Workers = None,
    executor: ExecutorName = "process",
    address: Address = None,
    shard: Shard = None,
    retry_failed: RetryFailed = False,
    dry_run: DryRun = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Status as JSON.")] = False,
) -> None:
    """Run all combinations of a sweep file; results that the study holds are not run again.

    Whatever stops it, what was finished is kept, and the same command goes on from there. With
    'status STUDY' it says how far a study is and what went wrong; with 'merge STUDY FROM...' it
    puts the parts that --shard made into one study.

    Example: ncsim sweep factorial.yaml -o study/ && ncsim report study/
    """
    verb, *rest = file
    if verb == "status" and rest:
        _status(Path(rest[0]), as_json=as_json)
        return
    if verb == "merge" and len(rest) > 1:
        _merge(Path(rest[0]), [Path(each) for each in rest[1:]], as_json=as_json)
        return
    if dry_run and not rest:
        _foresee(verb)
        return
    if rest or output is None:
        raise ScenarioError("give one sweep file and -o STUDY, or 'status STUDY', or 'merge ...'")
    from ncsim_core.sweep.running import SweepOptions

    options = SweepOptions(workers, executor, address, _shard(shard), retry_failed)
    _carry_out(verb, output, options, quiet=quiet)


def _carry_out(file: str, output: Path, options: "SweepOptions", *, quiet: bool) -> None:
    from ncsim_core.sweep.running import run_sweep

    with run_sweep(file, output, options) as results:
        counts = _carried_out(results, quiet=quiet)
    typer.echo(f"{results.plan.name}: {_summary(counts)}, in {output}/")
    _warn_of_repetition(results.plan)
    if counts.keys() - {"completed"}:
        typer.echo(f"ncsim sweep status {output} says why runs did not complete", err=True)
        raise typer.Exit(ExitCode.RUN_DID_NOT_COMPLETE)


def _warn_of_repetition(plan: "SweepPlan") -> None:
    if plan.repeats_itself:
        typer.echo(
            f"note: network and workload are the same under all {len(plan.seeds)} seeds; only "
            "components that draw (a random scheduler, shadowing) make a difference, and intervals "
            "over the others say nothing",
            err=True,
        )


def _carried_out(results: "SweepResults", *, quiet: bool) -> Counter[str]:
    line = ProgressLine(is_wanted=not quiet)
    counts: Counter[str] = Counter()
    pace = Pace()
    try:
        for done, record in enumerate(results, start=1):
            counts[record["status"]] += 1
            rate = pace.at(done)
            line.show(_progress(done, results.planned, rate, counts))
    except KeyboardInterrupt:
        line.clear()
        message = "interrupted; what was done is kept, the same command goes on from there"
        print(message, file=sys.stderr)  # noqa: T201 - the command line speaks through stderr
        raise typer.Exit(ExitCode.INTERRUPTED) from None
    finally:
        line.clear()
    return counts


def _progress(done: int, planned: int, per_s: float, counts: Counter[str]) -> str:
    left = f"{(planned - done) / per_s:.0f} s left" if per_s > 0 else "time left unknown"
    failed = done - counts["completed"]
    return f"{done}/{planned} runs, {per_s:.0f}/s, {left}, {failed} not completed"


def _summary(counts: "Counter[str] | dict[str, Any]") -> str:
    return ", ".join(f"{count} {status}" for status, count in sorted(counts.items())) or "no runs"


def _shard(text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    first, _, count = text.partition("/")
    if not (first.isdigit() and count.isdigit()):
        raise ScenarioError(f"--shard {text!r}: expected I/N, e.g. --shard 1/4")
    return int(first), int(count)


def _foresee(file: str) -> None:
    """Say what a sweep file would do."""
    from ncsim_core.sweep.reading import load_sweep

    plan = load_sweep(file)
    typer.echo(f"{plan.name}: {sum(1 for _ in plan.runs())} runs")
    for axis in plan.axes:
        typer.echo(f"  {len(axis.levels):5d} x {', '.join(axis.paths)}")
    typer.echo(f"  {len(plan.seeds):5d} x seed")
    for text in plan.where:
        typer.echo(f"  where {text}")
    _warn_of_repetition(plan)


def _status(study: Path, *, as_json: bool) -> None:
    from ncsim_core.sweep.store import Store

    with Store(study, must_exist=True) as store:
        plan, runs = store.current()
        counts, errors = store.counts(), store.errors(SHOWN_ERRORS)
    left = runs - sum(counts.values())
    if as_json:
        rows = [dict(zip(("status", "error", "runs"), each, strict=True)) for each in errors]
        found = {"name": plan.name, "runs": runs, "to_do": left, "counts": counts, "errors": rows}
        typer.echo(json.dumps(found, indent=2))
        return
    typer.echo(f"{plan.name}: {runs} runs, {_summary(counts)}, {left} to do")
    for status, error, count in errors:
        first, *more = error.splitlines() or [""]
        typer.echo(f"  {count} {status}: {first[:ERROR_WIDTH]}{' ...' if more else ''}")


def _merge(study: Path, others: list[Path], *, as_json: bool) -> None:
    from ncsim_core.sweep.store import Store

    with ExitStack() as open_studies:
        sources = [open_studies.enter_context(Store(each, must_exist=True)) for each in others]
        store = open_studies.enter_context(Store(study))
        for source in sources:
            store.merge(source)
    _status(study, as_json=as_json)
