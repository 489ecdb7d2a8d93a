"""``ncsim sweep``: many runs from one file; status and merging of studies."""

import sys
import time
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ncsim_core.cli.exit_codes import ExitCode
from ncsim_core.cli.progress import ProgressLine
from ncsim_core.errors import ScenarioError

if TYPE_CHECKING:
    from ncsim_core.sweep.running import SweepResults


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
    workers: Annotated[int | None, typer.Option("--workers", "-j", min=1)] = None,
    executor: Annotated[
        str, typer.Option(help="process, serial, dask, or one that a package offers.")
    ] = "process",
    address: Annotated[str | None, typer.Option(help="Of the Dask scheduler, tcp://...")] = None,
    shard: Annotated[
        str | None, typer.Option(metavar="I/N", help="Do part I of N only, for job arrays.")
    ] = None,
    retry_failed: Annotated[
        bool, typer.Option("--retry-failed", help="Do runs again that failed or hit a limit.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress.")] = False,
) -> None:
    """Run all combinations of a sweep file; results that the study holds are not run again.

    Example: ncsim sweep factorial.yaml -o study/ && ncsim report study/
    """
    verb, *rest = file
    if verb == "status" and rest:
        _status(Path(rest[0]))
        return
    if verb == "merge" and len(rest) > 1:
        _merge(Path(rest[0]), [Path(each) for each in rest[1:]])
        return
    if rest or output is None:
        raise ScenarioError("give one sweep file and -o STUDY, or 'status STUDY', or 'merge ...'")
    from ncsim_core.sweep.running import SweepOptions, run_sweep

    options = SweepOptions(workers, executor, address, _shard(shard), retry_failed)
    with run_sweep(verb, output, options) as results:
        counts = _carried_out(results, quiet=quiet)
    typer.echo(f"{results.plan.name}: {_summary(counts)}, in {output}/")
    if counts.keys() - {"completed"}:
        raise typer.Exit(ExitCode.RUN_DID_NOT_COMPLETE)


def _carried_out(results: "SweepResults", *, quiet: bool) -> Counter[str]:
    line = ProgressLine(is_wanted=not quiet)
    counts: Counter[str] = Counter()
    started_s = time.monotonic()
    try:
        for done, record in enumerate(results, start=1):
            counts[record["status"]] += 1
            line.show(_progress(done, results.planned, time.monotonic() - started_s, counts))
    except KeyboardInterrupt:
        line.clear()
        message = "interrupted; what was done is kept, the same command goes on from there"
        print(message, file=sys.stderr)  # noqa: T201 - the command line speaks through stderr
        raise typer.Exit(ExitCode.INTERRUPTED) from None
    finally:
        line.clear()
    return counts


def _progress(done: int, planned: int, spent_s: float, counts: Counter[str]) -> str:
    rate = done / spent_s if spent_s > 0 else 0.0
    left_s = (planned - done) / rate if rate > 0 else 0.0
    failed = done - counts["completed"]
    return f"{done}/{planned} runs, {rate:.0f}/s, {left_s:.0f} s left, {failed} not completed"


def _summary(counts: "Counter[str] | dict[str, Any]") -> str:
    return ", ".join(f"{count} {status}" for status, count in sorted(counts.items())) or "no runs"


def _shard(text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    first, _, count = text.partition("/")
    if not (first.isdigit() and count.isdigit()):
        raise ScenarioError(f"--shard {text!r}: expected I/N, e.g. --shard 1/4")
    return int(first), int(count)


def _status(study: Path) -> None:
    from ncsim_core.sweep.store import Store

    with Store(study, must_exist=True) as store:
        plan, runs = store.current()
        counts = store.counts()
    left = runs - sum(counts.values())
    typer.echo(f"{plan.name}: {runs} runs, {_summary(counts)}, {left} to do")


def _merge(study: Path, others: list[Path]) -> None:
    from ncsim_core.sweep.store import Store

    with Store(study) as store:
        for other in others:
            with Store(other, must_exist=True) as source:
                store.merge(source)
    _status(study)
