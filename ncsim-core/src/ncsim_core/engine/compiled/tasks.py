"""Tasks: readiness, queueing first come first served, running."""

from typing import Final

from ncsim_core import units
from ncsim_core.compiling import inlined
from ncsim_core.engine.compiled.event_queue import push
from ncsim_core.engine.compiled.layout import (
    COMPLETED,
    NONE,
    QUEUED,
    READY,
    RUNNING,
    node_at,
    outgoing_at,
    task_at,
    transfer_at,
)
from ncsim_core.engine.compiled.records import Record
from ncsim_core.engine.compiled.transfers import create_transfer, deliver_input
from ncsim_core.engine.events import TASK_COMPLETE, TASK_READY, TASK_START

us_from_s: Final = inlined(units.us_from_s)


@inlined
def release_tasks(first: int, end: int, state: Record) -> None:
    """Release the tasks of a DAG that wait for nothing."""
    for task in range(first, end):
        if task_at(task, state).missing == 0:
            push(state.now_us, TASK_READY, task, state)


@inlined
def task_becomes_ready(task: int, state: Record) -> None:
    """Reserve the task's node for it, or let it wait there."""
    run = task_at(task, state)
    run.ready_us = state.now_us
    node = node_at(run.node, state)
    if node.task == NONE:
        reserve(node, task, state)
        run.status = READY
    else:
        run.status = QUEUED
        wait_behind(node, task, state)


@inlined
def start_task(task: int, state: Record) -> bool:
    """Begin to run a task; return whether its node was reserved for it.

    Source: Section IV-B, a task takes cost over capacity.
    """
    now_us, run = state.now_us, task_at(task, state)
    node = node_at(run.node, state)
    if node.task != task:
        return False
    run.status, run.started_us = RUNNING, now_us
    push(now_us + us_from_s(run.cost / node.capacity), TASK_COMPLETE, task, state)
    return True


@inlined
def complete_task(task: int, state: Record) -> None:
    """End a task: hand its node to the head of the queue, then pass its results on."""
    run = task_at(task, state)
    run.status, run.ended_us = COMPLETED, state.now_us
    state.unfinished_tasks -= 1
    state.last_task_end_us = state.now_us
    node = node_at(run.node, state)
    node.task = NONE
    if node.waiting > 0:
        reserve(node, first_waiting(node, state), state)
    for at in range(run.first_outgoing, run.end_outgoing):
        dependency = outgoing_at(at, state).number
        target = transfer_at(dependency, state).target
        if task_at(target, state).node == run.node:
            deliver_input(target, state)
        else:
            create_transfer(dependency, state)


@inlined
def reserve(node: Record, task: int, state: Record) -> None:
    """Keep a node for a task before its start event, so that no other start can claim it."""
    node.task = task
    push(state.now_us, TASK_START, task, state)


@inlined
def wait_behind(node: Record, task: int, state: Record) -> None:
    """Put a task at the end of a node's line."""
    task_at(task, state).behind = NONE
    if node.waiting == 0:
        node.first_waiting = task
    else:
        task_at(node.last_waiting, state).behind = task
    node.last_waiting = task
    node.waiting += 1


@inlined
def first_waiting(node: Record, state: Record) -> int:
    """Take the first task off a node's line."""
    task: int = node.first_waiting
    node.first_waiting = task_at(task, state).behind
    node.waiting -= 1
    return task
