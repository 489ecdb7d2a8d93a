"""All targets in one table: what was aimed at, what was measured, and what peers take.

    make bench                          the table, to stdout and to out/bench.md
    python benchmarks/bench.py WORD...  only lines with all of these words in their name
    python benchmarks/bench.py --all    with what takes minutes: long runs, the sweep, slow peers

Every line is measured by one of the scripts beside this one in a process of its own, in CPU
seconds, by default as a median of 5; *in loops* divides by what a fixed loop took before. Peers are
measured in the same run if ``make bench-peers`` has set them up, and ratios to them come last.
"""

import importlib.util
import os
import platform
import re
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from engine import SIZES, TARGETS_s
from memory_by_size import CASES

HERE: Final = Path(__file__).parent
OUTPUT: Final = HERE.parent / "out" / "bench.md"
HEADINGS: Final = ("what", "target", "measured", "ratio", "verdict", "in loops")
MACHINE: Final = "this machine: 2,000,000 turns of a Python loop"
"""What other times are compared with, so that a slow hour of the machine is seen as such."""


@dataclass(frozen=True)
class Line:
    """One line of the table.

    Args:
        name: What is measured.
        command: Script beside this one, and its arguments.
        pattern: Finds the number in what the script prints.
        target: What the number should not pass; ``None`` where there is no target.
        unit: Of both.
        is_pure: Whether compiled loops are switched off.
        is_long: Whether it takes minutes.
    """

    name: str
    command: tuple[str, ...]
    pattern: str = r"([\d.]+) s"
    target: float | None = None
    unit: str = "s"
    is_pure: bool = True
    is_long: bool = False


def all_lines() -> Iterator[Line]:
    """Yield every line in the order of the table."""
    yield from _small_lines()
    yield from _engine_lines()
    yield from _long_lines()
    yield from _peer_lines()


def _small_lines() -> Iterator[Line]:
    yield Line(MACHINE, ("timing.py",))
    over = r"([\d.]+) s over"
    yield Line("start: ncsim --help, over python", ("start_up.py", "help"), over, 0.100)
    yield Line("start: ncsim run, 3 tasks, HEFT", ("start_up.py", "run"), target=0.300)
    yield Line("start: ncsim run, 4x4 grid with radio", ("start_up.py", "radio"))
    yield Line("load 20x20 x 10,000: YAML", ("loading.py", "yaml"), target=3.0)
    yield Line("load 20x20 x 10,000: JSON", ("loading.py", "json"), target=0.5)
    for nodes, tasks, target_s in ((16, 20, 0.001), (100, 1_000, 0.3), (400, 10_000, 3.0)):
        command = ("planner.py", "--only", str(nodes), str(tasks))
        yield Line(f"plan: HEFT, {nodes} nodes x {tasks:,}", command, target=target_s)


def _engine_lines() -> Iterator[Line]:
    for when in ("first", "again"):
        name = f"run: the paper's 108 grid runs with scheduling, {when}"
        yield Line(name, ("engine.py", "paper_runs"), rf"{when}: ([\d.]+) s", 0.25)
    models = {"none": "none", "pure": "csma_bianchi"}
    if importlib.util.find_spec("numba"):
        models |= {"loop": "none, compiled", "fast": "csma_bianchi, compiled"}
    for form, model in models.items():
        for size, tasks in SIZES:
            yield Line(
                f"run: {model}, {size}x{size} x {tasks:,}",
                ("engine.py", "one", form, str(size), str(tasks)),
                r"tasks\s+([\d.]+) s",
                TARGETS_s.get((form, size, tasks)),
                is_pure=form in ("none", "pure"),
            )
    share = r": (\d+) % of it"
    for model in ("none", "csma_bianchi"):
        for size in (5, 20):
            command = ("engine.py", "trace_share", str(size), "1000", model)
            name = f"trace: share of a run, {model}, {size}x{size} x 1,000"
            yield Line(name, command, share, 30, "%")
    command = ("engine.py", "long_run", "100000")
    yield Line("trace: share of a run, none, 100,000 events", command, share, 30, "%")


def _long_lines() -> Iterator[Line]:
    short = ("engine.py", "long_run", "10000")
    yield Line("length: 10,000 events, each", short, r"([\d.]+) us each", unit="us")
    command = ("engine.py", "long_run", "1000000")
    each = r"([\d.]+) us each"
    yield Line("length: 1,000,000 events, each", command, each, unit="us", is_long=True)
    name = "length: 1,000,000 events, trace streamed"
    yield Line(name, command, r"with trace\s+([\d.]+) s", 15, is_long=True)
    yield Line(f"{name}: its share", command, r": (\d+) % of it", 30, "%", is_long=True)
    yield Line(f"{name}: memory", command, r"(\d+) MB run", 500, "MB", is_long=True)
    for form in ("pure", "compiled") if importlib.util.find_spec("numba") else ("pure",):
        name, grown = f"memory: 30,000 to 1,000,000 events, {form}", ("memory.py", form)
        yield Line(f"{name}, per 100,000", grown, r"and ([\d.]+) MB per", unit="MB", is_long=True)
        yield Line(f"{name}, off a line", grown, r"is (\d+) % off", 15, "%", is_long=True)
    for case in CASES:
        command = ("memory_by_size.py", "one", case)
        each = r"\| (\d+) \| \d+ \| [\d.]+ \|$"
        yield Line(f"memory: {case}, per event", command, each, unit="bytes", is_long=True)
    for model in ("none", "csma_bianchi"):
        name = f"memory: 2,000 nodes, 10,000 tasks, {model}"
        command = ("memory.py", "large", model)
        yield Line(name, command, r"peak (\d+) MB", unit="MB", is_long=True)
    name = "sweep: 10,000 runs of 3x3 x 5, wall clock, two workers"
    yield Line(name, ("sweep.py",), r"runs in ([\d.]+) s", 60, is_long=True)


def _peer_lines() -> Iterator[Line]:
    peers = HERE.parent / "out" / "peers"
    has = {
        "simgrid": (peers / "simgrid_lv08").exists(),
        "published": (peers / "venv" / "bin" / "ncsim").exists(),
    }
    for peer, label in (("simgrid", "SimGrid LV08"), ("published", "published ncsim, none")):
        for size, tasks in SIZES if has[peer] else ():
            is_long = tasks == 10_000
            repeats = ("none", "1") if is_long else ()
            command = ("peers/run.py", peer, str(size), str(tasks), *repeats)
            name = f"peer: {label}, {size}x{size} x {tasks:,}"
            yield Line(name, command, r"tasks ([\d.]+) s", is_long=is_long)
    for size, tasks in ((5, 1_000), (20, 100)) if has["published"] else ():
        command = ("peers/run.py", "published", str(size), str(tasks), "csma_bianchi", "1")
        name = f"peer: published ncsim, csma_bianchi, {size}x{size} x {tasks:,}"
        yield Line(name, command, r"tasks ([\d.]+) s", is_long=True)


def measured(line: Line) -> float | None:
    """Return what a line's script says, ``None`` if it failed."""
    environment = os.environ | {"NCSIM_PURE": "1" if line.is_pure else "0"}
    command = [sys.executable, str(HERE / line.command[0]), *line.command[1:]]
    done = subprocess.run(command, check=False, capture_output=True, text=True, env=environment)
    found = re.search(line.pattern, done.stdout)
    if done.returncode or not found:
        print(f"{line.name}: {' '.join(command)} failed\n{done.stderr[-600:]}", file=sys.stderr)
        return None
    return float(found[1])


def cells(line: Line, value: float | None, loop_s: float) -> tuple[str, ...]:
    """Return what stands in a line.

    Args:
        line: The line.
        value: What was measured.
        loop_s: What a fixed loop took on this machine just before.
    """
    shown = "failed" if value is None else f"{value:.3g} {line.unit}"
    loops = f"{value / loop_s:.3g}" if value is not None and line.unit == "s" else ""
    if line.target is None or value is None:
        return line.name, "", shown, "", "", loops
    ratio = value / line.target
    verdict = "met" if ratio <= 1 else "missed"
    return line.name, f"{line.target:g} {line.unit}", shown, f"{ratio:.2f}", verdict, loops


def ratios_to_peers(seconds: Mapping[str, float]) -> Iterator[str]:
    """Yield how many times as long as a peer ncsim takes, for what both were measured on."""
    for name, theirs_s in seconds.items():
        peer, _, what = name.removeprefix("peer: ").rpartition(", ")
        model = "csma_bianchi" if "csma_bianchi" in peer else "none"
        ours_s = seconds.get(f"run: {model}, {what}")
        if name.startswith("peer: ") and ours_s is not None:
            yield f"ncsim takes {ours_s / theirs_s:.3g} times as long as {peer}, {what}"


def main() -> None:
    """Measure, print and write the table."""
    words = [word for word in sys.argv[1:] if word != "--all"]
    chosen = [
        line
        for line in all_lines()
        if all(word in line.name for word in words)
        and (words or "--all" in sys.argv or not line.is_long)
    ]
    about = f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores, Python "
    head = [
        f"{time.strftime('%Y-%m-%d')}, {about}{platform.python_version()}. CPU time, medians of 5.",
        "",
        "| " + " | ".join(HEADINGS) + " |",
        "|---|---:|---:|---:|---|---:|",
    ]
    print("\n".join(head), flush=True)
    loop_s = measured(Line(MACHINE, ("timing.py",))) or 1.0
    rows, seconds = [], {}
    for line in chosen:
        value = measured(line)
        if value is not None and line.unit == "s":
            seconds[line.name] = value
        rows.append("| " + " | ".join(cells(line, value, loop_s)) + " |")
        print(rows[-1], flush=True)
    rows += ["", *(f"- {each}" for each in ratios_to_peers(seconds))]
    print("\n".join(rows[len(chosen) :]), flush=True)
    OUTPUT.parent.mkdir(exist_ok=True)
    OUTPUT.write_text("\n".join([*head, *rows]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
