"""What a worker does: a chunk of runs, each to a row, whatever happens in it."""

import faulthandler
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final, NamedTuple

from ncsim_core.engine.accompanying import accompanied
from ncsim_core.engine.alarm import GRACE_s, StuckError, alarm
from ncsim_core.engine.outcome import Outcome, RunStatus
from ncsim_core.engine.setup import Limits
from ncsim_core.engine.simulation import Simulation
from ncsim_core.errors import NcsimError
from ncsim_core.memory import limited_memory
from ncsim_core.scenario.assembly import assemble
from ncsim_core.sweep.axes import Run
from ncsim_core.sweep.plan import RunLimits, plan_from_json
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.units import us_from_s

LAST_GRACE_s: Final = 2.0
"""What a call that cannot even be interrupted gets on top before its worker ends."""
FIRST_RUN_s: Final = 5.0
"""What the first run of a worker gets on top, for it imports the plug-ins."""


class Item(NamedTuple):
    """A run that waits to be done, and the key of its result."""

    key: str
    run: Run


class ResultRow(NamedTuple):
    """What is kept of a run; ``makespan_us`` only if it completed."""

    key: str
    status: str
    makespan_us: int | None
    ended_us: int | None
    events: int | None
    transfers: int | None
    remote_MB: float | None
    route_work_MB_hops: float | None
    wall_s: float
    error: str | None


def prepare_worker() -> None:
    """Make this process one that leaves quietly: on Ctrl-C the parent decides, and if it dies, too.

    Called once in each process of the local pool.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_leave_with, args=(parent,), daemon=True).start()


def _leave_with(parent: "multiprocessing.process.BaseProcess") -> None:
    parent.join()
    os._exit(1)


def ready() -> bool:
    """Return that a worker has started."""
    return True


def run_chunk(plan_text: str, items: Sequence[Item]) -> list[ResultRow]:
    """Return the results of some runs of a plan, in their order."""
    resolver = _resolver(plan_text)
    return [_result(item, resolver) for item in items]


@dataclass
class _Worker:
    """What this process remembers."""

    has_run: bool = False


_WORKER = _Worker()


@lru_cache(maxsize=1)
def _nowhere() -> int:
    """Return a descriptor, open as long as this process, for a traceback that nobody reads."""
    return os.open(os.devnull, os.O_WRONLY)


@lru_cache(maxsize=4)
def _resolver(plan_text: str) -> Resolver:
    return Resolver(plan_from_json(plan_text))


def failed_row(key: str, error: str, wall_s: float = 0.0, status: str = "failed") -> ResultRow:
    """Return the row of a run that gave no result."""
    return ResultRow(key, status, None, None, None, None, None, None, wall_s, error)


def _result(item: Item, resolver: Resolver) -> ResultRow:
    started_s = time.perf_counter()
    limits = resolver.plan.limits
    interrupted_s = _interrupted_s(limits)
    _set_last_alarm(interrupted_s)
    try:
        with limited_memory(limits.memory_MB), alarm(interrupted_s):
            return _simulated(item, resolver, limits, started_s)
    except StuckError as stuck:
        return _out_of_time(item, limits, started_s, stuck.place)
    except NcsimError as error:
        return failed_row(item.key, str(error), time.perf_counter() - started_s)
    except (Exception, SystemExit) as error:  # a plug-in may do anything; the sweep goes on
        text = f"{type(error).__name__}: {error}"
        return failed_row(item.key, text, time.perf_counter() - started_s)
    finally:
        _WORKER.has_run = True
        if limits.wall_s is not None:
            faulthandler.cancel_dump_traceback_later()


def _interrupted_s(limits: RunLimits) -> float | None:
    """Return when a run that hangs where the clock is not looked at is interrupted."""
    slack_s = GRACE_s if _WORKER.has_run else GRACE_s + FIRST_RUN_s
    return None if limits.wall_s is None else limits.wall_s + slack_s


def _set_last_alarm(interrupted_s: float | None) -> None:
    """End this worker if a run cannot be interrupted; needs no GIL."""
    is_expendable = multiprocessing.parent_process() is not None
    if interrupted_s is not None and is_expendable:
        last_s = interrupted_s + LAST_GRACE_s
        faulthandler.dump_traceback_later(last_s, exit=True, file=_nowhere())


def _out_of_time(item: Item, limits: RunLimits, started_s: float, place: str = "") -> ResultRow:
    error = f"the wall limit of {limits.wall_s:g} s{'; ' if place else ''}{place}"
    wall_s = time.perf_counter() - started_s
    return failed_row(item.key, error, wall_s, str(RunStatus.LIMIT_REACHED))


def _simulated(item: Item, resolver: Resolver, limits: RunLimits, started_s: float) -> ResultRow:
    scenario = resolver.scenario(item.run)
    assembly = assemble(scenario)
    max_time_us = None if limits.max_time_s is None else us_from_s(limits.max_time_s)
    engine_limits = Limits(limits.max_events, max_time_us)
    simulation = Simulation(assembly.network, assembly.models, engine_limits)
    with accompanied(simulation, scenario.name, scenario.config.seed):
        outcome = _run(simulation, limits.wall_s)
    if outcome is None:
        return _out_of_time(item, limits, started_s)
    wall_s = time.perf_counter() - started_s
    transfers = simulation.state.transfers.values()
    return ResultRow(
        item.key,
        str(outcome.status),
        outcome.makespan_us,
        outcome.ended_us,
        outcome.events,
        len(transfers),
        sum(each.entry.size_MB for each in transfers),
        sum(each.entry.size_MB * len(each.route) for each in transfers),
        wall_s,
        outcome.detail or None,
    )


def _run(simulation: Simulation, wall_s: float | None) -> Outcome | None:
    """Return how a run ended; ``None`` if time on the clock ran out."""
    return simulation.run() if wall_s is None else simulation.run_until(time.monotonic() + wall_s)
