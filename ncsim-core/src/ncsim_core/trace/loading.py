"""Reads a trace into tables."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ncsim_core.trace.building import RunBuilder
from ncsim_core.trace.reader import read_trace
from ncsim_core.trace.records import (
    Done,
    Ended,
    Injected,
    Note,
    Placed,
    RatesAssigned,
    Ready,
    Started,
    TraceRecord,
    TransferEnded,
    TransferStarted,
)
from ncsim_core.trace.run_trace import RateStep, RunEnd, RunTrace


def load_run(path: Path | str) -> RunTrace:
    """Read a trace, or the trace in a run's folder, into tables.

    Raises:
        TraceError: It is no trace, or names a node, link, task or transfer that it has not
            introduced.
    """
    with read_trace(path) as reader:
        builder = RunBuilder(reader.preamble)
        for record in reader:
            try:
                enter(record, builder)
            except ValueError as error:
                raise reader.fault(str(error)) from error
        return builder.build()


class Introduced(NamedTuple):
    """How many of each a trace has introduced so far; numbers must be below."""

    nodes: int
    links: int
    dags: int
    tasks: int
    edges: int


def enter(record: TraceRecord, builder: RunBuilder) -> None:
    """Enter a record into tables in the making.

    Raises:
        ValueError: It names something that was not introduced.
    """
    preamble = builder.preamble
    counts = map(len, (preamble.nodes, preamble.links, builder.dags, builder.names, builder.edges))
    expect_introduced(record, Introduced(*counts))
    builder.now_us = record.at_us
    match record:
        case Injected():
            builder.inject(record)
        case Placed(_, _, dag, nodes):
            builder.place(dag, nodes)
        case Ready() | Started() | Ended():
            _enter_task(record, builder)
        case TransferStarted() | TransferEnded() | RatesAssigned():
            _enter_transfer(record, builder)
        case Done(_, at_us, status, makespan_us, events, detail):
            builder.end = RunEnd(status, at_us, makespan_us, events, detail)
        case Note():
            pass


def expect_introduced(record: TraceRecord, introduced: Introduced) -> None:
    """Check that every number in a record points to something.

    Raises:
        ValueError: One does not.
    """
    match record:
        case Placed(_, _, dag, nodes):
            _expect_below(introduced.dags, "DAG", [dag])
            _expect_below(introduced.nodes, "node", nodes)
        case Ready(_, _, task, node) | Started(_, _, task, node) | Ended(_, _, task, node):
            _expect_below(introduced.tasks, "task", [task])
            _expect_below(introduced.nodes, "node", [node])
        case TransferStarted(_, _, transfer, route):
            _expect_below(introduced.edges, "transfer", [transfer])
            _expect_below(introduced.links, "link", route)
        case TransferEnded(_, _, transfer):
            _expect_below(introduced.edges, "transfer", [transfer])
        case RatesAssigned():
            _expect_below(introduced.edges, "transfer", [record.cause[1], *record.transfers])
            _expect_below(introduced.links, "link", record.bottlenecks)
        case Injected() | Note() | Done():
            pass


def _expect_below(count: int, what: str, numbers: list[int]) -> None:
    for number in numbers:
        if number >= count:
            raise ValueError(f"{what} {number} has not been introduced; there are {count}")


def _enter_task(record: Ready | Started | Ended, builder: RunBuilder) -> None:
    match record:
        case Ready():
            builder.ready_us[record.task] = record.at_us
        case Started():
            builder.started_us[record.task] = record.at_us
        case Ended():
            builder.ended_us[record.task] = record.at_us


def _enter_transfer(
    record: TransferStarted | TransferEnded | RatesAssigned, builder: RunBuilder
) -> None:
    match record:
        case TransferStarted(_, at_us, transfer, route):
            _expect_usable(route, builder)
            builder.route[transfer] = tuple(route)
            builder.transfer_started_us[transfer] = at_us
        case TransferEnded(_, at_us, transfer):
            if not builder.route[transfer]:
                raise ValueError(f"xend: transfer {transfer} has not started")
            builder.end_transfer(transfer, at_us)
        case RatesAssigned():
            for transfer, step in rate_steps(record):
                _expect_on_route(step.bottleneck, transfer, builder)
                builder.add_step(transfer, step)


def _expect_usable(route: list[int], builder: RunBuilder) -> None:
    if not route:
        raise ValueError("xstart: the route is empty")
    for link in route:
        if builder.preamble.links[link].bandwidth_MBps <= 0:
            raise ValueError(f"xstart: link {link} of the route has no bandwidth")


def _expect_on_route(link: int, transfer: int, builder: RunBuilder) -> None:
    if link not in builder.route[transfer]:
        raise ValueError(f"recalc: bottleneck {link} is not on the route of transfer {transfer}")


def rate_steps(record: RatesAssigned) -> Iterator[tuple[int, RateStep]]:
    """Yield each transfer of a ``recalc`` record with its new rate."""
    change, cause = record.cause
    for transfer, rate_MBps, link, contenders, hidden, factor, flows in zip(
        record.transfers,
        record.rates_MBps,
        record.bottlenecks,
        record.contenders,
        record.hidden_interferers,
        record.hidden_factors,
        record.flows,
        strict=True,
    ):
        yield (
            transfer,
            RateStep(
                record.at_us, rate_MBps, link, contenders, hidden, factor, flows, change, cause
            ),
        )
