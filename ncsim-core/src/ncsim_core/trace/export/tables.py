"""A run as flat tables, for CSV and Parquet: times in seconds, names instead of numbers."""

import csv
import importlib
import io
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Final, NamedTuple, TypeAlias

from ncsim_core.trace.files import appearing, write_atomically
from ncsim_core.trace.records import TraceError
from ncsim_core.trace.run_trace import RunTask, RunTrace
from ncsim_core.units import s_from_us

Cell: TypeAlias = str | float | int | bool | None


class Table(NamedTuple):
    """Column names with their types, and rows."""

    columns: Mapping[str, type]
    rows: Callable[[RunTrace], Iterator[tuple[Cell, ...]]]


def _seconds(instant: int | None) -> float | None:
    return None if instant is None else s_from_us(instant)


def _node_id(task: RunTask, run: RunTrace) -> str | None:
    return None if task.node is None else run.nodes[task.node].id


def _task_rows(run: RunTrace) -> Iterator[tuple[Cell, ...]]:
    for task in run.tasks:
        times = map(_seconds, (task.ready_us, task.started_us, task.ended_us))
        dag = run.dags[task.dag]
        yield (
            task.number,
            dag.id,
            task.id,
            task.cost,
            _node_id(task, run),
            s_from_us(dag.injected_us),
            *times,
        )


def _transfer_rows(run: RunTrace) -> Iterator[tuple[Cell, ...]]:
    for transfer in run.transfers:
        source, target = run.tasks[transfer.source], run.tasks[transfer.target]
        yield (
            transfer.number,
            run.dags[transfer.dag].id,
            source.id,
            target.id,
            _node_id(source, run),
            _node_id(target, run),
            transfer.size_MB,
            transfer.is_local,
            " ".join(run.links[link].id for link in transfer.route),
            run.solo_MBps(transfer) if transfer.route else None,
            *map(_seconds, (transfer.created_us, transfer.started_us, transfer.ended_us)),
            transfer.served_MB,
        )


def _rate_rows(run: RunTrace) -> Iterator[tuple[Cell, ...]]:
    for transfer in run.transfers:
        for step, until_us in run.rate_spans(transfer):
            yield (
                transfer.number,
                s_from_us(step.at_us),
                s_from_us(until_us),
                step.rate_MBps,
                run.links[step.bottleneck].id,
                step.flows,
                step.contenders,
                step.hidden_interferers,
                step.hidden_factor,
                "start" if step.change == "s" else "end",
                step.cause,
            )


TABLES: Final[Mapping[str, Table]] = {
    "tasks": Table(
        {
            "number": int,
            "dag": str,
            "task": str,
            "cost": float,
            "node": str,
            "injected_s": float,
            "ready_s": float,
            "started_s": float,
            "ended_s": float,
        },
        _task_rows,
    ),
    "transfers": Table(
        {
            "number": int,
            "dag": str,
            "source_task": str,
            "target_task": str,
            "source_node": str,
            "target_node": str,
            "size_MB": float,
            "is_local": bool,
            "route": str,
            "solo_MBps": float,
            "created_s": float,
            "started_s": float,
            "ended_s": float,
            "served_MB": float,
        },
        _transfer_rows,
    ),
    "rates": Table(
        {
            "transfer": int,
            "from_s": float,
            "to_s": float,
            "rate_MBps": float,
            "bottleneck": str,
            "flows": int,
            "contenders": int,
            "hidden_interferers": int,
            "hidden_factor": float,
            "change": str,
            "cause": int,
        },
        _rate_rows,
    ),
}


def write_csv(run: RunTrace, folder: Path) -> None:
    """Write ``tasks.csv``, ``transfers.csv`` and ``rates.csv``; empty cells are missing values."""
    for name, table in TABLES.items():
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(table.columns)
        writer.writerows(table.rows(run))
        write_atomically(folder / f"{name}.csv", text.getvalue())


def write_parquet(run: RunTrace, folder: Path) -> None:
    """Write ``tasks.parquet``, ``transfers.parquet`` and ``rates.parquet``, zstd-compressed.

    Raises:
        TraceError: pyarrow is not installed.
    """
    try:
        arrow = importlib.import_module("pyarrow")
        parquet = importlib.import_module("pyarrow.parquet")
    except ImportError as error:
        raise TraceError("--to parquet needs pyarrow: pip install pyarrow, or use csv") from error
    types = {int: arrow.int64(), float: arrow.float64(), str: arrow.string(), bool: arrow.bool_()}
    for name, table in TABLES.items():
        schema = arrow.schema([(column, types[kind]) for column, kind in table.columns.items()])
        rows = [dict(zip(table.columns, row, strict=True)) for row in table.rows(run)]
        content = arrow.Table.from_pylist(rows, schema=schema)
        with appearing(folder / f"{name}.parquet") as place:
            parquet.write_table(content, place, compression="zstd")
