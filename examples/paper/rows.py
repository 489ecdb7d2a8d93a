"""Every printed row of the paper's workflow evaluation, and what it comes out as here."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from ncsim_core.metrics.statistics import slowdown
from ncsim_core.sweep.report import policies, policy_totals
from ncsim_core.sweep.table import Table
from route_load import RouteLoad

EXPECTED: dict[str, Any] = yaml.safe_load(
    (Path(__file__).parent / "expected.yaml").read_text(encoding="utf-8")
)
LARGE = 20
TIE = 1e-6
LETTERS = {"heft": "H", "cpop": "C", "round_robin": "RR"}
ROUTINGS = ("widest_path", "minimum_hop")
FULL = "csma_bianchi"


class Row(NamedTuple):
    """A printed row, and what it comes out as."""

    table: str
    case: str
    printed: list[Any]
    found: list[Any]

    @property
    def is_equal(self) -> bool:
        """Return whether every cell comes out as it is printed."""
        return list(map(str, self.printed)) == list(map(str, self.found))


def routing_rows(runs: Table) -> Iterator[Row]:
    """Yield tab:routing."""
    found = makespans(runs, "network.size", "dags.tasks", "routing")
    for size, tasks, *printed in EXPECTED["routing"]:
        wide, short = (found[size, tasks, routing] for routing in ROUTINGS)
        winner = "Tie" if abs(wide - short) <= TIE * wide else "Min-hop"
        winner = "Widest" if wide < short * (1 - TIE) else winner
        yield Row("tab:routing", case(size, tasks), printed, [f2(wide), f2(short), winner])


def interference_rows(runs: Table) -> Iterator[Row]:
    """Yield tab:interference."""
    found = makespans(runs, "network.size", "dags.tasks", "scheduler", "interference")
    for size, tasks, *printed in EXPECTED["interference"]:
        cells: list[Any] = []
        for scheduler in ("heft", "cpop"):
            solo, full = (found[size, tasks, scheduler, mode] for mode in ("none", FULL))
            cells += [f2(solo), f2(full), f"{100 * ((slowdown(full, solo) or 0) - 1):.0f}%"]
        yield Row("tab:interference", case(size, tasks), printed, cells)


def factorial_rows(runs: Table) -> Iterator[Row]:
    """Yield tab:winner_matrix, the regret bars and the summary statistics."""
    matrix = policies(runs, "scheduler", "interference")
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
        yield Row("fig:regret_scatter", f"{case(size, tasks)} {routing}", [printed], [f3(ratio)])
    above = sum(record["regret"] > TIE for record in found.values())
    yield Row("fig:regret_scatter", "bars above one", [EXPECTED["bars_above_one"]], [above])
    totals = dict(policy_totals(matrix).rows)
    for name, printed in EXPECTED["totals"].items():
        value = totals[name]
        text = str(value) if isinstance(value, int) else f"{100 * value:.1f}%"
        yield Row("statistics", name, [printed], [text])


def payload_rows(runs: Table) -> Iterator[Row]:
    """Yield what the text and fig:ccr say of payloads."""
    found = makespans(runs, "dags.tasks", "dags.payload_MB", "interference")
    ratios = {key[:2]: found[*key[:2], FULL] / found[*key[:2], "none"] for key in found}
    for tasks, payload, *printed in EXPECTED["payload"]:
        solo, full = found[tasks, payload, "none"], found[tasks, payload, FULL]
        cells = [f2(solo), f2(full), f2(ratios[tasks, payload])]
        yield Row("fig:ccr", f"{tasks} tasks, {payload} MB", printed, cells)
    peak = max((p for t, p in ratios if t == LARGE), key=lambda p: ratios[LARGE, p])
    yield Row("fig:ccr", f"peak of {LARGE} tasks", ["10 MB"], [f"{peak} MB"])
    remote = {(r["dags.tasks"], r["dags.payload_MB"]): r["remote_MB"] for r in runs.to_dicts()}
    for tasks, start in EXPECTED["colocated_from_MB"].items():
        first = min(p for t, p in remote if t == tasks and remote[t, p] == 0)
        yield Row("fig:ccr", f"{tasks} tasks on one node from", [f"{start} MB"], [f"{first} MB"])


def concurrent_rows(runs: Table) -> Iterator[Row]:
    """Yield fig:multidag."""
    found = makespans(runs, "dags.count", "interference")
    for count, printed in EXPECTED["concurrent"]:
        cells = [f2(found[count, mode]) for mode in ("none", FULL)]
        yield Row("fig:multidag", f"{count} DAGs", [printed, printed], cells)


def route_load_rows(loads: list[RouteLoad]) -> Iterator[Row]:
    """Yield fig:routing-topo: the load of routes on the 4x4 grid with 20 tasks."""
    by_name = {load.routing: load for load in loads}
    for routing, *printed in EXPECTED["route_load"]:
        load = by_name[routing]
        result, counts = load.result, load.dependencies
        cells = [f"{result.remote_MB:g}", f"{result.route_work_MB_hops:g}", f2(load.mean_hops)]
        cells += [str(len(counts)), str(max(counts.values())), f2(result.makespan_s)]
        yield Row("fig:routing-topo", routing, printed, cells)
    wide, short = ((by_name[routing].result.makespan_s or 0.0) for routing in ROUTINGS)
    yield Row("fig:routing-topo", "ratio", [EXPECTED["route_load_ratio"]], [f2(wide / short)])


def makespans(runs: Table, *columns: str) -> dict[tuple[Any, ...], float]:
    """Return makespans by the values of some columns."""
    return {tuple(r[c] for c in columns): r["makespan_s"] for r in runs.to_dicts()}


def case(size: int, tasks: int) -> str:
    """Return how a grid and a DAG are called."""
    return f"{size}x{size} {tasks}T"


def f2(value: float | None) -> str:
    """Return a number with the two digits that the paper prints."""
    return "-" if value is None else f"{value:.2f}"


def f3(value: float) -> str:
    """Return a number with three digits."""
    return f"{value:.3f}"
