"""Tasks: injection, readiness, queueing, running."""

from collections.abc import Iterable

from ncsim_core.contracts.queue_model import WaitingTask
from ncsim_core.contracts.scheduler import ActiveTransfer, NetworkSnapshot
from ncsim_core.engine.boundary import checked_placement
from ncsim_core.engine.events import TASK_COMPLETE, TASK_READY, TASK_START
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import NodeState, State, TaskRun, TaskStatus, Transfer
from ncsim_core.engine.transfers import create_transfer, deliver_input
from ncsim_core.errors import EngineError
from ncsim_core.units import s_from_us, us_from_s

READY, QUEUED, RUNNING, COMPLETED = (
    TaskStatus.READY, TaskStatus.QUEUED, TaskStatus.RUNNING, TaskStatus.COMPLETED
)  # fmt: skip  # a member is slow to look up


def inject_dag(dag_number: int, state: State, setup: Setup) -> None:
    """Plan a DAG, check that its data can travel, and release the tasks that wait for nothing."""
    place_dag(dag_number, snapshot(state, setup), state, setup)
    if state.unroutable:
        return
    first = setup.first_task[dag_number]
    for run in state.tasks[first : first + len(setup.injections[dag_number].dag.tasks)]:
        if run.missing == 0:
            state.queue.push_soon(state.now_us, TASK_READY, run.entry.number)


def place_dag(dag_number: int, seen: NetworkSnapshot, state: State, setup: Setup) -> None:
    """Plan a DAG, tell those who watch, and note what in it has no route."""
    dag = setup.injections[dag_number].dag
    nodes = checked_placement(setup.models, dag, seen)
    first = setup.first_task[dag_number]
    for run, node in zip(state.tasks[first : first + len(nodes)], nodes, strict=True):
        run.node = node
    state.free_tasks_placed += [task.pinned_to for task in dag.tasks].count(None)
    if state.log is not None:
        state.log.tell()
    for watcher in state.watchers:
        watcher.dag_injected(state.now_us, dag_number, nodes)
    state.unroutable += unroutable_dependencies(dag_number, state, setup)


def unroutable_dependencies(dag_number: int, state: State, setup: Setup) -> list[str]:
    """Return a line for each dependency between two nodes that no usable route connects."""
    first = setup.first_dependency[dag_number]
    count = len(setup.injections[dag_number].dag.dependencies)
    entries = setup.dependencies[first : first + count]
    tasks, route = state.tasks, setup.routes.route
    ends = [(tasks[entry.source].node, tasks[entry.target].node) for entry in entries]
    apart = {
        (source, target)
        for source, target in dict.fromkeys(ends)
        if source != target and route(source, target) is None
    }
    return [
        _unroutable_line(tasks[entry.source], tasks[entry.target], setup)
        for entry, pair in zip(entries, ends, strict=True)
        if apart and pair in apart
    ]


def _unroutable_line(source: TaskRun, target: TaskRun, setup: Setup) -> str:
    dag = setup.injections[source.entry.dag].dag
    from_node = setup.network.nodes[source.node].id
    to_node = setup.network.nodes[target.node].id
    return f"{dag.id}: {source.entry.task.id} on {from_node} -> {target.entry.task.id} on {to_node}"


def snapshot(state: State, setup: Setup) -> NetworkSnapshot:
    """Return what a scheduler may see now."""
    depths = [len(node.queue) + (node.task is not None) for node in state.nodes]
    under_way = [each for each in state.transfers.values() if each.is_under_way]
    return snapshot_of(depths, under_way, state, setup)


def snapshot_of(
    queue_depths: Iterable[int], under_way: Iterable[Transfer], state: State, setup: Setup
) -> NetworkSnapshot:
    """Return what a scheduler may see of nodes, and of the transfers under way as created."""
    return NetworkSnapshot(
        network=setup.network,
        routes=setup.routes,
        now_s=s_from_us(state.now_us),
        queue_depths=tuple(queue_depths),
        active_transfers=tuple(_active_transfers(under_way, state, setup)),
        free_tasks_placed=state.free_tasks_placed,
    )


def _active_transfers(
    under_way: Iterable[Transfer], state: State, setup: Setup
) -> list[ActiveTransfer]:
    active = []
    for transfer in under_way:
        source, target = (state.tasks[n] for n in (transfer.entry.source, transfer.entry.target))
        elapsed_s = s_from_us(state.now_us - transfer.credited_us)
        active.append(
            ActiveTransfer(
                setup.injections[transfer.entry.dag].dag.id,
                source.entry.task.id,
                target.entry.task.id,
                source.node,
                target.node,
                max(0.0, transfer.remaining_MB - transfer.rate_MBps * elapsed_s),
            )
        )
    return active


def task_becomes_ready(task: int, state: State, setup: Setup) -> None:
    """Reserve the task's node for it, or let it wait there."""
    run = state.tasks[task]
    run.ready_us = state.now_us
    for observer in state.observers:
        observer.task_ready(state.now_us, task, run.node)
    node = state.nodes[run.node]
    if node.task is None:
        _reserve(node, task, state)
        run.status = READY
    else:
        run.status = QUEUED
        node.queue.push(waiting_task(run, setup))


def start_task(task: int, state: State, setup: Setup) -> None:
    """Begin to run a task on the node that is reserved for it.

    Source: Section IV-B, a task takes cost over capacity.
    """
    run = state.tasks[task]
    if state.nodes[run.node].task != task:
        raise EngineError(f"task {task} starts on a node reserved for another")
    run.status, run.started_us = RUNNING, state.now_us
    for observer in state.observers:
        observer.task_started(state.now_us, task, run.node)
    capacity = setup.network.nodes[run.node].compute_capacity
    duration_us = us_from_s(run.entry.task.compute_cost / capacity)
    state.queue.push(state.now_us + duration_us, TASK_COMPLETE, task)


def complete_task(task: int, state: State, setup: Setup) -> None:
    """End a task: hand its node to the head of the queue, then pass its results on."""
    run = state.tasks[task]
    run.status, run.ended_us = COMPLETED, state.now_us
    state.unfinished_tasks -= 1
    state.last_task_end_us = state.now_us
    for observer in state.observers:
        observer.task_ended(state.now_us, task, run.node)
    node = state.nodes[run.node]
    node.task = None
    if node.queue:
        _reserve(node, node.queue.pop().ticket, state)
    for dependency in run.entry.outgoing:
        target = setup.dependencies[dependency].target
        target_node = state.tasks[target].node
        if target_node == run.node:
            deliver_input(target, state)
        else:
            create_transfer(dependency, run.node, target_node, state, setup)


def _reserve(node: NodeState, task: int, state: State) -> None:
    """Keep a node for a task before its start event, so that no other start can claim it."""
    node.task = task
    state.queue.push_soon(state.now_us, TASK_START, task)


def waiting_task(run: TaskRun, setup: Setup) -> WaitingTask:
    """Return what a queue is told of a task."""
    dag = setup.injections[run.entry.dag].dag
    task = run.entry.task
    return WaitingTask(dag.id, task.id, task.compute_cost, run.ready_us or 0, run.entry.number)
