"""The bars of a Gantt chart, from a trace or a result, for everything that draws one in Python."""

from collections.abc import Iterator
from typing import Literal, NamedTuple

from ncsim_core.api import RunResult
from ncsim_core.trace.run_trace import RunTrace
from ncsim_core.units import s_from_us


class Bar(NamedTuple):
    """A stretch of time on a lane.

    Args:
        lane: Number of the lane.
        kind: What takes the time.
        label: Of the task or transfer.
        dag: Number of its DAG, for colour.
        start_s: From when.
        end_s: Until when; of what did not end, when the run stopped.
    """

    lane: int
    kind: Literal["task", "transfer"]
    label: str
    dag: int
    start_s: float
    end_s: float


class Chart(NamedTuple):
    """A Gantt chart.

    Args:
        title: Scenario and how it ended.
        lanes: Names: each node, then what it sends.
        bars: Tasks, then transfers.
        end_s: Where the time axis ends.
    """

    title: str
    lanes: tuple[str, ...]
    bars: tuple[Bar, ...]
    end_s: float


def chart_of_run(run: RunTrace) -> Chart:
    """Return the chart of a trace: per node a lane of tasks and one of outgoing transfers."""
    end_s = s_from_us(run.end.ended_us)
    makespan = "" if run.end.makespan_us is None else f", {s_from_us(run.end.makespan_us):g} s"
    title = f"{run.header.scenario or 'run'}: {run.end.status}{makespan}"
    bars = (*_task_bars(run, end_s), *_transfer_bars(run, end_s))
    return _chart(title, [node.id for node in run.nodes], bars, end_s)


def chart_of_result(result: RunResult, title: str = "run") -> Chart:
    """Return the chart of a result, as ``chart_of_run`` does for its trace."""
    nodes = sorted({task.node for task in result.tasks if task.node is not None})
    lanes = {node: 2 * number for number, node in enumerate(nodes)}
    dags = list(dict.fromkeys(task.dag for task in result.tasks))
    placement = result.placement
    tasks = (
        Bar(
            lanes[task.node], "task", _label(task.dag, task.task, dags), dags.index(task.dag),
            task.started_s, result.ended_s if task.ended_s is None else task.ended_s,
        )
        for task in result.tasks
        if task.node is not None and task.started_s is not None
    )  # fmt: skip
    transfers = (
        Bar(
            lanes[placement[each.dag, each.source_task]] + 1, "transfer",
            f"{_label(each.dag, each.source_task, dags)} -> {each.target_task}",
            dags.index(each.dag), each.started_s,
            result.ended_s if each.ended_s is None else each.ended_s,
        )
        for each in result.transfers
        if each.started_s is not None
    )  # fmt: skip
    makespan = "" if result.makespan_s is None else f", {result.makespan_s:g} s"
    heading = f"{title}: {result.status}{makespan}"
    return _chart(heading, nodes, (*tasks, *transfers), result.ended_s)


def _label(dag: str, task: str, dags: list[str]) -> str:
    return f"{dag}/{task}" if len(dags) > 1 else task


def _task_bars(run: RunTrace, end_s: float) -> Iterator[Bar]:
    for task in run.tasks:
        if task.node is not None and task.started_us is not None:
            stop_s = end_s if task.ended_us is None else s_from_us(task.ended_us)
            label = run.task_label(task.number)
            start_s = s_from_us(task.started_us)
            yield Bar(2 * task.node, "task", label, task.dag, start_s, stop_s)


def _transfer_bars(run: RunTrace, end_s: float) -> Iterator[Bar]:
    for transfer in run.transfers:
        source = run.tasks[transfer.source].node
        if source is not None and transfer.started_us is not None:
            stop_s = end_s if transfer.ended_us is None else s_from_us(transfer.ended_us)
            label = run.transfer_label(transfer.number)
            start_s = s_from_us(transfer.started_us)
            yield Bar(2 * source + 1, "transfer", label, transfer.dag, start_s, stop_s)


def _chart(title: str, nodes: list[str], bars: tuple[Bar, ...], end_s: float) -> Chart:
    """Return a chart without the lanes that nothing is on."""
    used = sorted({bar.lane for bar in bars})
    number = {lane: place for place, lane in enumerate(used)}
    lanes = tuple(f"{nodes[lane // 2]}{' sends' if lane % 2 else ''}" for lane in used)
    moved = tuple(bar._replace(lane=number[bar.lane]) for bar in bars)
    return Chart(title, lanes, moved, end_s)


class Row(NamedTuple):
    """Where a bar stands within its lane.

    Args:
        bar: The bar.
        bottom: Lower edge, from 0 to 1 of the lane, counted downwards.
        height: As a part of the lane.
    """

    bar: Bar
    bottom: float
    height: float


def rows_of(chart: Chart) -> list[Row]:
    """Return the bars beside each other where they overlap, so that all are seen."""
    rows: list[Row] = []
    for lane in range(len(chart.lanes)):
        bars = sorted(
            (bar for bar in chart.bars if bar.lane == lane), key=lambda each: each.start_s
        )
        ends_s: list[float] = []
        places: list[int] = []
        for bar in bars:
            free = next((at for at, end_s in enumerate(ends_s) if end_s <= bar.start_s), None)
            if free is None:
                free = len(ends_s)
                ends_s.append(0.0)
            ends_s[free] = bar.end_s
            places.append(free)
        height = 1 / max(1, len(ends_s))
        rows += [Row(bar, at * height, height) for bar, at in zip(bars, places, strict=True)]
    return rows
