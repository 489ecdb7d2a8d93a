"""From the engine's objects to records: once for a run, and once for each DAG that is placed."""

from collections.abc import Sequence
from itertools import chain

import numpy as np

from ncsim_core.engine.compiled import layout
from ncsim_core.engine.compiled.arrays import Arrays, records
from ncsim_core.engine.compiled.layout import NONE, NOT_YET
from ncsim_core.engine.compiled.records import Record
from ncsim_core.engine.setup import Setup
from ncsim_core.network import NodeIndex, Route
from ncsim_core.units import NEVER_us, us_from_s


def loaded(setup: Setup) -> Arrays:
    """Return the records of a run before its first event, without a radio."""
    tasks, transfers, links = len(setup.tasks), len(setup.dependencies), len(setup.network.links)
    outgoing = chain.from_iterable(entry.outgoing for entry in setup.tasks)
    arrays = Arrays(unfinished_tasks=tasks)
    arrays.put_all({
        "tasks": _tasks(setup),
        "transfers": _transfers(setup),
        "outgoing": np.fromiter(outgoing, np.int64, transfers),
        "created": np.zeros(transfers, np.int64),
        "affected": np.zeros(transfers, np.int64),
        "moves": records(transfers, layout.MOVE),
        "hops": records(0, layout.HOP),
        "links": records(links, layout.LINK, factor=1.0, first_hop=NONE, last_hop=NONE),
        "switched": np.zeros(links, np.int64),
        "nodes": records(len(setup.network.nodes), layout.NODE, task=NONE),
        "queue": records(tasks + transfers + len(setup.injections), layout.ENTRY),
    })  # fmt: skip
    arrays["links"].bandwidth_MBps = setup.bandwidth_MBps
    arrays["nodes"].capacity = [node.compute_capacity for node in setup.network.nodes]
    _enter_injections(setup, arrays)
    return arrays


def _tasks(setup: Setup) -> Record:
    tasks = records(len(setup.tasks), layout.TASK, node=NONE, behind=NONE)
    tasks.ready_us = tasks.started_us = tasks.ended_us = NOT_YET
    tasks.cost = [entry.task.compute_cost for entry in setup.tasks]
    tasks.missing = [entry.incoming_count for entry in setup.tasks]
    ends = np.cumsum([len(entry.outgoing) for entry in setup.tasks], dtype=np.int64)
    tasks.end_outgoing = ends
    tasks.first_outgoing[1:] = ends[:-1]
    return tasks


def _transfers(setup: Setup) -> Record:
    transfers = records(len(setup.dependencies), layout.TRANSFER, bottleneck=NONE, place=NONE)
    transfers.created_us = transfers.started_us = transfers.ended_us = NOT_YET
    transfers.completes_us = NEVER_us
    transfers.source = [entry.source for entry in setup.dependencies]
    transfers.target = [entry.target for entry in setup.dependencies]
    transfers.rank = [entry.rank for entry in setup.dependencies]
    transfers.size_MB = [entry.size_MB for entry in setup.dependencies]
    return transfers


def _enter_injections(setup: Setup, arrays: Arrays) -> None:
    """Put the injections on the queue; sorted as they are, they are a heap."""
    count = len(setup.injections)
    queue = arrays["queue"][:count]
    queue.at_us = [injection.at_us for injection in setup.injections]
    queue.order = queue.number = range(count)
    arrays.state.entries = arrays.state.tickets = count


def place(dag_number: int, nodes: Sequence[NodeIndex], setup: Setup, arrays: Arrays) -> None:
    """Put the tasks of one DAG on their nodes and its transfers on their routes."""
    first = setup.first_task[dag_number]
    arrays["tasks"].node[first : first + len(nodes)] = nodes
    begin = setup.first_dependency[dag_number]
    count = len(setup.injections[dag_number].dag.dependencies)
    if count == 0:
        return
    rows = arrays["transfers"][begin : begin + count]
    routes = _routes(rows, setup, arrays)
    first_hop = int(arrays.state.hop_count)
    rows.end_hop = np.cumsum([len(route) for route in routes], dtype=np.int64) + first_hop
    rows.first_hop[0] = first_hop
    rows.first_hop[1:] = rows.end_hop[:-1]
    if not setup.is_without_latency:
        latency_s = setup.network.route_latency_s
        rows.latency_us = [us_from_s(latency_s(route)) for route in routes]
    hops = _more_hops(int(rows.end_hop[-1]) - first_hop, arrays)
    hops.link = np.fromiter(chain.from_iterable(routes), np.int32, len(hops))
    hops.transfer = np.repeat(np.arange(begin, begin + count), rows.end_hop - rows.first_hop)


def _more_hops(count: int, arrays: Arrays) -> Record:
    """Return so many hops more, which are the last."""
    known, used = arrays["hops"], int(arrays.state.hop_count)
    if used + count > len(known):
        more = records(max(used + count, 2 * len(known)), layout.HOP)
        more[:used] = known[:used]
        arrays.put("hops", more)
    arrays.state.hop_count = used + count
    return arrays["hops"][used : used + count]


def _routes(rows: Record, setup: Setup, arrays: Arrays) -> list[Route]:
    """Return the route of each dependency, empty where both ends are on one node."""
    node, route = arrays["tasks"].node, setup.routes.route
    ends = zip(node[rows.source].tolist(), node[rows.target].tolist(), strict=True)
    return [() if source == target else route(source, target) or () for source, target in ends]
