"""Carries the scenario of a run's folder out again and compares what it leaves."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice, zip_longest
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import BinaryIO, cast

from ncsim_core.api import RunResult, simulate
from ncsim_core.errors import PluginError, ScenarioError
from ncsim_core.registry import get_registry
from ncsim_core.scenario.loader import load_scenario
from ncsim_core.sweep.store import STORE_NAME
from ncsim_core.trace.fields import RECORDS
from ncsim_core.trace.output import METRICS_NAME, SCENARIO_NAME
from ncsim_core.trace.reader import opened, read_trace
from ncsim_core.trace.records import TraceHeader, TraceLevel, TracePreamble
from ncsim_core.trace.show import readable_lines
from ncsim_core.trace.writer import TraceWriter

SHOWN = 160
"""Characters of a record that are shown."""
FIRST_RECORD = 2
"""Line of a trace on which its records begin."""


@dataclass(frozen=True)
class Reproduction:
    """What came of a run that was carried out again.

    Args:
        records: Records that were compared.
        result: The run made here.
        versions: Where packages are of another version, a line each.
        faults: Why the folder is not what it seems; empty if all of it came out again.
    """

    records: int
    result: RunResult
    versions: tuple[str, ...]
    faults: tuple[str, ...]


def reproduction_of(folder: Path) -> Reproduction:
    """Return whether the scenario in a run's folder gives its trace and its metrics again.

    Raises:
        TraceError: The folder holds no trace, or it is no trace.
        ScenarioError: The folder holds no scenario, or a wrong one.
        PluginError: A package that took part in the run is not installed.
    """
    if (folder / STORE_NAME).exists():
        raise ScenarioError(
            f"{folder}: is a study, which keeps no traces; say which of its runs, as in "
            f"ncsim reproduce {folder}@seed=1"
        )
    with read_trace(folder) as reader:
        preamble, trace = reader.preamble, reader.path
    path = trace.parent / SCENARIO_NAME
    if not path.is_file():
        raise ScenarioError(f"{folder}: holds no {SCENARIO_NAME}; folders of ncsim run -o do")
    _refuse_missing(folder, preamble)
    _refuse_limited(trace.parent)
    scenario = load_scenario(path)
    faults = []
    if scenario.sha256 != preamble.header.scenario_sha256:
        faults.append(f"{path} was changed after the run, or is of another one")
    with TemporaryDirectory(prefix="ncsim-") as place:
        again = Path(place) / "trace.jsonl"
        level = cast("TraceLevel", preamble.level)
        result = simulate(scenario, observers=[TraceWriter(again, TraceHeader.of(scenario), level)])
        same, parting = _compared(trace, again)
    versions = tuple(_other_versions(preamble))
    faults += parting
    if len(parting) > 1 and not versions and len(faults) == len(parting):
        faults.append(_suspicion(preamble))
    return Reproduction(same, result, versions, (*faults, *_wrong_metrics(trace)))


def _refuse_missing(folder: Path, preamble: TracePreamble) -> None:
    """Raise if a package that took part is not installed.

    Raises:
        PluginError: One is not.
    """
    installed = {each.distribution for each in get_registry().plugins}
    missing = [each for each in preamble.plugins.values() if each.distribution not in installed]
    if missing:
        listed = "; ".join(
            f"{each}: pip install {each.distribution}=={each.version}" for each in missing
        )
        raise PluginError(f"{folder}: was made with what is not installed here: {listed}")


def _refuse_limited(folder: Path) -> None:
    """Raise if the run stopped at a limit, which the scenario does not hold.

    Raises:
        ScenarioError: It did.
    """
    path = folder / METRICS_NAME
    if (
        path.is_file()
        and json.loads(path.read_text(encoding="utf-8")).get("status") == "limit_reached"
    ):
        raise ScenarioError(
            f"{folder}: stopped at a limit, which scenario.yaml does not hold; run it with the "
            f"options that run.json lists, and ncsim compare the two"
        )


def _other_versions(preamble: TracePreamble) -> Iterator[str]:
    here = {each.distribution: each.version for each in get_registry().plugins}
    there = {each.distribution: each.version for each in preamble.plugins.values()}
    core, _, version = preamble.header.software.partition(" ")
    for name, old in ({core: version} | there).items():
        if here.get(name, old) != old:
            yield f"{name} {old} there, {here[name]} here"


def _compared(there: Path, here: Path) -> tuple[int, list[str]]:
    """Return how many records are equal, and where the traces part, if they do."""
    with opened(there) as old, opened(here) as new:
        faults = _header_faults(old, new)
        pairs = zip_longest(old, new)
        for number, (mine, theirs) in enumerate(pairs):
            if mine != theirs:
                parting = _parting(number, there, here, mine or b"", theirs or b"")
                return number, [*faults, *parting]
        return number + 1, faults


def _header_faults(old: BinaryIO, new: BinaryIO) -> list[str]:
    """Return which parts of the header differ, versions and hash aside."""
    first, second = json.loads(old.readline()), json.loads(new.readline())
    told_apart = ("software", "plugins", "scenario_sha256", "scenario")
    keys = [key for key in {**first, **second} if key not in told_apart]
    return [f"the header says another {k}" for k in keys if first.get(k) != second.get(k)]


def _parting(number: int, there: Path, here: Path, old: bytes, new: bytes) -> list[str]:
    """Return what the first record that differs is on either side, as people read it."""
    line = number + FIRST_RECORD
    if not old.endswith(b"\n"):
        return [f"{there} is torn off at line {line}; the run goes on here"]
    first, second = (_record_at(number, path) for path in (there, here))
    if first == second:
        at = max(
            0, next(k for k, pair in enumerate(zip_longest(old, new)) if len({*pair}) > 1) - 40
        )
        first, second = (f"...{each[at:].decode().strip()}" for each in (old, new))
    return [
        f"the runs part at line {line} of the trace",
        f"  there  {first[:SHOWN]}",
        f"  here   {second[:SHOWN]}",
    ]


def _record_at(number: int, trace: Path) -> str:
    lines = readable_lines(trace, RECORDS.keys())
    return next(islice(lines, number, None), "nothing more").strip()


def _suspicion(preamble: TracePreamble) -> str:
    own = sorted({each.distribution for each in preamble.plugins.values()})
    checks = ", ".join(name for name in own if not name.startswith("ncsim-core"))
    return (
        "scenario, seed and versions are the same: was the trace edited, or a package without a "
        "new version, or is one not repeatable? "
        f"ncsim plugins check tells ({checks or 'ncsim-core'})"
    )


def _wrong_metrics(trace: Path) -> list[str]:
    """Return which numbers of ``metrics.json`` are not those that the trace gives."""
    from ncsim_core.metrics import compute_metrics
    from ncsim_core.trace.loading import load_run

    path = trace.parent / METRICS_NAME
    run = load_run(trace)
    if not path.is_file() or run.end.status == "truncated":
        return []
    written, right = json.loads(path.read_text(encoding="utf-8")), compute_metrics(run)
    wrong = [key for key in right if written.get(key) != right[key]]
    if not wrong:
        return []
    key, *more = wrong
    differ = f"{key} is {_short(written.get(key))}; the trace gives {_short(right[key])}"
    return [f"{path}: {differ}" + (f"; {', '.join(more)} differ, too" if more else "")]


def _short(value: object) -> str:
    text = json.dumps(value)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."
