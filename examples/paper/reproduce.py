"""Carries out the paper's workflow evaluation and compares it with the printed numbers.

``make paper`` runs it. Every row is told to equal what the paper prints, or not; the exit code is 1
if any does not. Studies and figures are written to ``out/paper``.
"""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from ncsim_core.metrics.statistics import slowdown
from ncsim_core.sweep.report import policies, policy_totals
from ncsim_core.sweep.running import run_sweep
from ncsim_core.sweep.table import Table

HERE = Path(__file__).parent
OUTPUT = Path("out/paper")
EXPECTED: dict[str, Any] = yaml.safe_load((HERE / "expected.yaml").read_text(encoding="utf-8"))
LARGE = 20
LETTERS = {"heft": "H", "cpop": "C", "round_robin": "RR"}
ROUTINGS = ("widest_path", "minimum_hop")
FULL = "csma_bianchi"


class Row(NamedTuple):
    """A printed row, and what it comes out as."""

    table: str
    case: str
    printed: list[Any]
    found: list[Any]


def study(name: str) -> Table:
    """Return all runs of one of the sweep files beside this one."""
    with run_sweep(HERE / f"{name}.yaml", OUTPUT / name) as results:
        return results.table()


def makespans(runs: Table, *columns: str) -> dict[tuple[Any, ...], float]:
    """Return makespans by the values of some columns."""
    return {tuple(r[c] for c in columns): r["makespan_s"] for r in runs.to_dicts()}


def routing_rows() -> Iterator[Row]:
    """Yield tab:routing."""
    found = makespans(study("routing"), "network.size", "dags.tasks", "routing")
    for size, tasks, *printed in EXPECTED["routing"]:
        wide, short = (found[size, tasks, routing] for routing in ROUTINGS)
        winner = (
            "Tie" if abs(wide - short) <= 1e-6 * wide else "Min-hop" if short < wide else "Widest"
        )
        yield Row("tab:routing", case(size, tasks), printed, [f2(wide), f2(short), winner])


def interference_rows() -> Iterator[Row]:
    """Yield tab:interference."""
    names = ("network.size", "dags.tasks", "scheduler", "interference")
    found = makespans(study("interference"), *names)
    for size, tasks, *printed in EXPECTED["interference"]:
        cells: list[Any] = []
        for scheduler in ("heft", "cpop"):
            solo, full = (found[size, tasks, scheduler, mode] for mode in ("none", FULL))
            cells += [f2(solo), f2(full), f"{100 * ((slowdown(full, solo) or 0) - 1):.0f}%"]
        yield Row("tab:interference", case(size, tasks), printed, cells)


def factorial_rows() -> Iterator[Row]:
    """Yield tab:winner_matrix, the regret bars and the summary statistics."""
    matrix = policies(study("factorial"), "scheduler", "interference")
    found = {(r["network.size"], r["dags.tasks"], r["routing"]): r for r in matrix.to_dicts()}
    for size, tasks, *printed in EXPECTED["winner_matrix"]:
        cells: list[Any] = []
        for routing in ROUTINGS:
            record = found[size, tasks, routing]
            cells += [f2(record[name]) for name in LETTERS]
            cells.append("/".join(LETTERS[name] for name in record["solo_winners"].split("/")))
        yield Row("tab:winner_matrix", case(size, tasks), printed, cells)
    for size, tasks, routing, printed in EXPECTED["regret"]:
        ratio = 1 + found[size, tasks, routing]["regret"]
        yield Row("fig:regret", f"{case(size, tasks)} {routing}", [printed], [f"{ratio:.3f}"])
    totals = dict(policy_totals(matrix).rows)
    for name, printed in EXPECTED["totals"].items():
        value = totals[name]
        text = str(value) if isinstance(value, int) else f"{100 * value:.1f}%"
        yield Row("statistics", name, [printed], [text])


def payload_rows() -> Iterator[Row]:
    """Yield what the text and fig:ccr say of payloads."""
    runs = study("payload")
    found = makespans(runs, "dags.tasks", "dags.payload_MB", "interference")
    ratios = {key[:2]: found[*key[:2], FULL] / found[*key[:2], "none"] for key in found}
    for tasks, payload, *printed in EXPECTED["payload"]:
        solo, full = found[tasks, payload, "none"], found[tasks, payload, FULL]
        cells = [f2(solo), f2(full), f"{ratios[tasks, payload]:.2f}"]
        yield Row("fig:ccr", f"{tasks} tasks {payload} MB", printed, cells)
    peak = max((p for t, p in ratios if t == LARGE), key=lambda p: ratios[LARGE, p])
    yield Row("fig:ccr", "peak of 20 tasks", ["10 MB"], [f"{peak} MB"])
    remote = {(r["dags.tasks"], r["dags.payload_MB"]): r["remote_MB"] for r in runs.to_dicts()}
    for tasks, start in EXPECTED["colocated_from_MB"].items():
        first = min(p for t, p in remote if t == tasks and remote[t, p] == 0)
        yield Row("fig:ccr", f"{tasks} tasks on one node from", [f"{start} MB"], [f"{first} MB"])


def concurrent_rows() -> Iterator[Row]:
    """Yield fig:multidag."""
    found = makespans(study("concurrent"), "dags.count", "interference")
    for count, printed in EXPECTED["concurrent"]:
        cells = [f2(found[count, mode]) for mode in ("none", FULL)]
        yield Row("fig:multidag", f"{count} DAGs", [printed, printed], cells)


def route_load_rows() -> Iterator[Row]:
    """Yield fig:routing-topo: the load of routes on the 4x4 grid with 20 tasks."""
    from collections import Counter

    from ncsim_core import simulate
    from ncsim_core.generators.paper import paper_dag, paper_grid
    from ncsim_core.scenario.making import make_scenario

    for routing, *printed in EXPECTED["route_load"]:
        config = {"scheduler": "heft", "routing": routing, "interference": FULL}
        result = simulate(make_scenario("load", paper_grid(4), [paper_dag(20)], config))
        load = Counter(
            frozenset(link.split("_")[1:]) for each in result.transfers for link in each.route
        )
        cells = [f"{result.remote_MB:g}", f"{result.route_work_MB_hops:g}", len(load)]
        cells += [max(load.values()), f2(result.makespan_s)]
        yield Row("fig:routing-topo", routing, printed, cells)


def case(size: int, tasks: int) -> str:
    """Return how a grid and a DAG are called."""
    return f"{size}x{size} {tasks}T"


def f2(value: float | None) -> str:
    """Return a number with the two digits that the paper prints."""
    return "-" if value is None else f"{value:.2f}"


def main() -> int:
    """Print every row and return the exit code."""
    parts = (routing_rows, interference_rows, factorial_rows, payload_rows, concurrent_rows)
    wrong = total = 0
    for part in (*parts, route_load_rows):
        for row in part():
            printed, found = list(map(str, row.printed)), list(map(str, row.found))
            is_equal = printed == found
            wrong += not is_equal
            total += 1
            verdict = "equal" if is_equal else f"DIFFERS, printed: {' '.join(printed)}"
            print(f"{row.table:<18} {row.case:<24} {' '.join(found)}  {verdict}")  # noqa: T201
    print(f"{total - wrong} of {total} rows equal what the paper prints")  # noqa: T201
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
