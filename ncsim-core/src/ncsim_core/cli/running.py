"""What ``ncsim run`` does once its options are read."""

import platform
import sys
import time
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from ncsim_core import __version__
from ncsim_core.api import RunResult, result_of
from ncsim_core.cli.guard import Guard
from ncsim_core.cli.progress import ProgressLine, RunProgress
from ncsim_core.engine.accompanying import accompanied
from ncsim_core.engine.observer import Watcher
from ncsim_core.engine.setup import Limits
from ncsim_core.engine.simulation import Simulation
from ncsim_core.errors import ScenarioError
from ncsim_core.scenario.assembly import assemble
from ncsim_core.scenario.model import Scenario
from ncsim_core.trace.files import json_text
from ncsim_core.trace.output import (
    METRICS_NAME,
    RUN_NAME,
    SCENARIO_NAME,
    atomic_output_folder,
    refuse_existing,
)
from ncsim_core.trace.records import TraceHeader, TraceLevel
from ncsim_core.trace.writer import TraceWriter


@dataclass(frozen=True)
class RunRequest:
    """One run as asked for on the command line.

    Args:
        scenario: What to run.
        limits: When to give up.
        output: Folder to write, if any.
        force: Whether an earlier run there may be replaced.
        trace_level: ``full``, ``coarse`` or ``off``.
        compress: Whether the trace is gzipped.
        quiet: Whether progress stays off.
        guard: Limits on the clock and on memory.
    """

    scenario: Scenario
    limits: Limits
    output: Path | None
    force: bool
    trace_level: str
    compress: bool
    quiet: bool
    guard: Guard


def execute(request: RunRequest) -> RunResult:
    """Run, and leave the output folder if one is asked for.

    Raises:
        ScenarioError: The folder exists, or the scenario is refused by a component.
        PluginError: A component does not build.
    """
    if request.trace_level not in ("full", "coarse", "off"):
        raise ScenarioError(f"--trace {request.trace_level!r}: choose full, coarse or off")
    line = ProgressLine(is_wanted=not request.quiet)
    observers: list[Watcher] = [RunProgress(line)] if line.is_shown else []
    try:
        if request.output is None:
            return _simulated(request, observers)
        refuse_existing(request.output, force=request.force)
        with atomic_output_folder(request.output, force=request.force) as folder:
            return _recorded(request, observers, folder)
    finally:
        line.clear()


def _simulated(request: RunRequest, observers: list[Watcher]) -> RunResult:
    scenario = request.scenario
    with request.guard.watching() as deadline_s:
        assembly = assemble(scenario)
        simulation = Simulation(assembly.network, assembly.models, request.limits, observers)
        with accompanied(simulation, scenario.name, scenario.config.seed):
            request.guard.run(simulation, deadline_s)
    return result_of(simulation)


def _recorded(request: RunRequest, observers: list[Watcher], folder: Path) -> RunResult:
    from ncsim_core.metrics import compute_metrics
    from ncsim_core.trace.recorder import RunRecorder

    scenario = request.scenario
    started_s = time.perf_counter()
    header = TraceHeader.of(scenario)
    # Metrics are those that the trace gives: without rates in it, none are counted either.
    counted: TraceLevel = "full" if request.trace_level == "full" else "coarse"
    recorder = RunRecorder(header, counted, keeps_steps=False)
    watching: list[Watcher] = [*observers, recorder]
    with ExitStack() as open_files:
        if request.trace_level != "off":
            name = "trace.jsonl.gz" if request.compress else "trace.jsonl"
            level = cast("TraceLevel", request.trace_level)
            # Flushing compressed data would make its bytes depend on the clock.
            writer = TraceWriter(folder / name, header, level, is_live=not request.compress)
            watching.append(open_files.enter_context(writer))
        result = _simulated(request, watching)
    metrics = compute_metrics(recorder.run_trace())
    wall_s = time.perf_counter() - started_s
    (folder / SCENARIO_NAME).write_text(scenario.to_yaml(), encoding="utf-8")
    (folder / METRICS_NAME).write_text(json_text(metrics), encoding="utf-8")
    (folder / RUN_NAME).write_text(json_text(_circumstances(wall_s, result)), encoding="utf-8")
    return result


def _circumstances(wall_s: float, result: RunResult) -> dict[str, object]:
    """Return what may differ between two equal runs."""
    return {
        "ncsim": __version__,
        "command": sys.argv,
        "status": str(result.status),
        "wall_s": round(wall_s, 6),
        "finished": time.strftime("%Y-%m-%dT%H:%M:%S%z"),
        "host": platform.node(),
        "platform": platform.platform(),
        "python": platform.python_version(),
    }
