"""``ncsim run``: one scenario to its end."""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ncsim_core.cli.choices import (
    InterferenceName,
    MaxEvents,
    MaxMemory,
    MaxTime,
    MaxWall,
    RoutingName,
    ScenarioPath,
    SchedulerName,
    Seed,
    Settings,
    component_line,
    limits_of,
    overrides_of,
    refuse_endless,
)
from ncsim_core.cli.exit_codes import ExitCode

if TYPE_CHECKING:
    from ncsim_core.api import RunResult
    from ncsim_core.scenario.model import Scenario


def run(  # noqa: PLR0913 - one parameter per option
    scenario: ScenarioPath,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Folder to write trace, metrics and scenario to."),
    ] = None,
    *,
    force: Annotated[bool, typer.Option("--force", help="Replace an earlier run there.")] = False,
    scheduler: SchedulerName = None,
    routing: RoutingName = None,
    interference: InterferenceName = None,
    seed: Seed = None,
    settings: Settings = None,
    max_events: MaxEvents = None,
    max_time: MaxTime = None,
    max_wall: MaxWall = None,
    max_memory: MaxMemory = None,
    trace: Annotated[
        str, typer.Option(help="What the trace holds: full, coarse (no rates) or off.")
    ] = "full",
    compress: Annotated[bool, typer.Option("--gzip", help="Write trace.jsonl.gz.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress, no notes.")] = False,
) -> None:
    """Run a scenario and print how it went; with -o, leave a folder with trace and metrics.

    Example: ncsim run examples/two_hop.yaml --interference none -o out/
    """
    from ncsim_core.cli.guard import Guard
    from ncsim_core.cli.running import RunRequest, execute
    from ncsim_core.scenario.loader import load_scenario

    refuse_endless(max_time=max_time, max_wall=max_wall, max_memory=max_memory)
    overrides = overrides_of(
        settings, scheduler=scheduler, routing=routing, interference=interference, seed=seed
    )
    loaded = load_scenario(scenario, overrides)
    if not quiet:
        for note in loaded.notes:
            print(f"{scenario}: note: {note}", file=sys.stderr)  # noqa: T201
    guard = Guard(max_wall, max_memory)
    limits = limits_of(max_events, max_time)
    request = RunRequest(loaded, limits, output, force, trace, compress, quiet, guard)
    result = execute(request)
    typer.echo(json.dumps(result.to_dict(), indent=2) if as_json else report(loaded, result))
    if output is not None and not as_json:
        typer.echo(f"  written    {output}/")
    if result.makespan_s is None:
        raise typer.Exit(ExitCode.RUN_DID_NOT_COMPLETE)


def report(scenario: "Scenario", result: "RunResult") -> str:
    """Return what people want to know of a run, in a few lines."""
    ended = sum(task.ended_s is not None for task in result.tasks)
    work = f"{result.remote_MB:g} MB, {result.route_work_MB_hops:g} MB-hops"
    lines = [
        f"{scenario.name}: {result.status}",
        f"  makespan   {'-' if result.makespan_s is None else f'{result.makespan_s:.6f} s'}",
        f"  tasks      {ended} of {len(result.tasks)} ended",
        f"  transfers  {len(result.transfers)} between nodes, {work}",
        f"  models     {component_line(scenario.config)}",
    ]
    if result.detail:
        lines.append(f"  why        {result.detail}")
    return "\n".join(lines)
