"""Tasks: injection, readiness, queueing, running."""

from ncsim_core.contracts.queue_model import WaitingTask
from ncsim_core.contracts.scheduler import ActiveTransfer, NetworkSnapshot
from ncsim_core.engine.boundary import checked_placement
from ncsim_core.engine.events import TaskComplete, TaskReady, TaskStart
from ncsim_core.engine.setup import Setup
from ncsim_core.engine.state import NodeState, State, TaskRun, TaskStatus
from ncsim_core.engine.transfers import create_transfer
from ncsim_core.errors import EngineError
from ncsim_core.units import s_from_us, us_from_s


def inject_dag(dag_number: int, state: State, setup: Setup) -> None:
    """Plan a DAG, check that its data can travel, and release the tasks that wait for nothing."""
    dag = setup.injections[dag_number].dag
    nodes = checked_placement(setup.models, dag, snapshot(state, setup))
    first = setup.first_task[dag_number]
    runs = state.tasks[first : first + len(dag.tasks)]
    for run, node in zip(runs, nodes, strict=True):
        run.node = node
        state.free_tasks_placed += run.entry.task.pinned_to is None
    for observer in state.observers:
        observer.dag_injected(state.now_us, dag_number, nodes)
    state.unroutable += unroutable_dependencies(dag_number, state, setup)
    if state.unroutable:
        return
    for run in runs:
        if run.missing == 0:
            state.queue.push(state.now_us, TaskReady.priority, TaskReady(run))


def unroutable_dependencies(dag_number: int, state: State, setup: Setup) -> list[str]:
    """Return a line for each dependency between two nodes that no usable route connects."""
    first = setup.first_dependency[dag_number]
    count = len(setup.injections[dag_number].dag.dependencies)
    lines = []
    for entry in setup.dependencies[first : first + count]:
        source, target = state.tasks[entry.source], state.tasks[entry.target]
        if source.node != target.node and setup.routes.route(source.node, target.node) is None:
            lines.append(_unroutable_line(source, target, setup))
    return lines


def _unroutable_line(source: TaskRun, target: TaskRun, setup: Setup) -> str:
    dag = setup.injections[source.entry.dag].dag
    from_node = setup.network.nodes[source.node].id
    to_node = setup.network.nodes[target.node].id
    return f"{dag.id}: {source.entry.task.id} on {from_node} -> {target.entry.task.id} on {to_node}"


def snapshot(state: State, setup: Setup) -> NetworkSnapshot:
    """Return what a scheduler may see now."""
    return NetworkSnapshot(
        network=setup.network,
        routes=setup.routes,
        now_s=s_from_us(state.now_us),
        queue_depths=tuple(len(node.queue) + (node.task is not None) for node in state.nodes),
        active_transfers=tuple(_active_transfers(state, setup)),
        free_tasks_placed=state.free_tasks_placed,
    )


def _active_transfers(state: State, setup: Setup) -> list[ActiveTransfer]:
    active = []
    for transfer in state.transfers.values():
        if not transfer.is_under_way:
            continue
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


def task_becomes_ready(run: TaskRun, state: State, setup: Setup) -> None:
    """Reserve the task's node for it, or let it wait there."""
    run.status, run.ready_us = TaskStatus.READY, state.now_us
    for observer in state.observers:
        observer.task_ready(state.now_us, run.entry.number, run.node)
    node = state.nodes[run.node]
    if node.task is None:
        _reserve(node, run, state)
    else:
        run.status = TaskStatus.QUEUED
        node.queue.push(_waiting_task(run, setup))


def start_task(run: TaskRun, state: State, setup: Setup) -> None:
    """Begin to run a task on the node that is reserved for it.

    Source: Section IV-B, a task takes cost over capacity.
    """
    if state.nodes[run.node].task is not run:
        raise EngineError(f"task {run.entry.number} starts on a node reserved for another")
    run.status, run.started_us = TaskStatus.RUNNING, state.now_us
    for observer in state.observers:
        observer.task_started(state.now_us, run.entry.number, run.node)
    capacity = setup.network.nodes[run.node].compute_capacity
    duration_us = us_from_s(run.entry.task.compute_cost / capacity)
    state.queue.push(state.now_us + duration_us, TaskComplete.priority, TaskComplete(run))


def complete_task(run: TaskRun, state: State, setup: Setup) -> None:
    """End a task: hand its node to the head of the queue, then pass its results on."""
    run.status, run.ended_us = TaskStatus.COMPLETED, state.now_us
    state.unfinished_tasks -= 1
    state.last_task_end_us = state.now_us
    for observer in state.observers:
        observer.task_ended(state.now_us, run.entry.number, run.node)
    node = state.nodes[run.node]
    node.task = None
    if node.queue:
        _reserve(node, state.tasks[node.queue.pop().ticket], state)
    for dependency in run.entry.outgoing:
        target = state.tasks[setup.dependencies[dependency].target]
        if target.node == run.node:
            deliver_input(target, state)
        else:
            create_transfer(dependency, run.node, target.node, state, setup)


def deliver_input(target: TaskRun, state: State) -> None:
    """Count one input of a task as arrived; with the last one it becomes ready."""
    target.missing -= 1
    if target.missing == 0:
        state.queue.push(state.now_us, TaskReady.priority, TaskReady(target))


def _reserve(node: NodeState, run: TaskRun, state: State) -> None:
    """Keep a node for a task before its start event, so that no other start can claim it."""
    node.task = run
    state.queue.push(state.now_us, TaskStart.priority, TaskStart(run))


def _waiting_task(run: TaskRun, setup: Setup) -> WaitingTask:
    dag = setup.injections[run.entry.dag].dag
    task = run.entry.task
    return WaitingTask(dag.id, task.id, task.compute_cost, run.ready_us or 0, run.entry.number)
