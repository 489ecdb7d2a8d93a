"""What is happening: everything about a run that changes."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING

from ncsim_core.engine.boundary import CheckedQueue, CheckedSession, asked
from ncsim_core.engine.event_queue import EventQueue
from ncsim_core.engine.sessions.choice import session_of
from ncsim_core.units import NEVER_us

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ncsim_core.engine.log import Log
    from ncsim_core.engine.numbering import DependencyEntry, TaskEntry
    from ncsim_core.engine.observer import Observer, Watcher
    from ncsim_core.engine.setup import Setup
    from ncsim_core.network import LinkIndex, NodeIndex, Route
    from ncsim_core.units import Instant

UNPLACED = -1


class TaskStatus(StrEnum):
    """The five states of a task, in order (paper, Section IV-B)."""

    PENDING = "pending"
    READY = "ready"
    QUEUED = "queued"
    RUNNING = "running"
    COMPLETED = "completed"


@dataclass(slots=True, eq=False)
class TaskRun:
    """A task on its way through the run.

    Args:
        entry: The task.
        missing: Inputs that have not arrived.
        node: Where it was placed, ``UNPLACED`` before its DAG is injected.
        status: How far it is.
        ready_us: When its last input arrived.
        started_us: When it began to run.
        ended_us: When it ended.
    """

    entry: TaskEntry
    missing: int
    node: NodeIndex = UNPLACED
    status: TaskStatus = TaskStatus.PENDING
    ready_us: Instant | None = None
    started_us: Instant | None = None
    ended_us: Instant | None = None


@dataclass(slots=True, eq=False)
class Transfer:
    """A dependency on its way between two nodes.

    Args:
        number: Of the dependency.
        rank: Of the dependency.
        entry: The dependency.
        route: The links it occupies, fixed when it was created.
        remaining_MB: Bytes not served up to ``credited_us``.
        created_us: When its producer ended; latency is paid from here.
        credited_us: Up to when service has been credited.
        rate_MBps: Service rate since then; 0 means that it is paused.
        bottleneck: First link of the route with the least share.
        completes_us: When its last byte will be served, as things are.
        entered_us: Time of its entry in the queue.
        started_us: When byte service began.
        ended_us: When the last byte was served.
    """

    number: int
    rank: int
    entry: DependencyEntry
    route: Route
    remaining_MB: float
    created_us: Instant
    credited_us: Instant = 0
    rate_MBps: float = 0.0
    bottleneck: LinkIndex = -1
    completes_us: Instant = NEVER_us
    entered_us: Instant = NEVER_us
    started_us: Instant | None = None
    ended_us: Instant | None = None

    @property
    def is_under_way(self) -> bool:
        """Return whether byte service has begun and not ended."""
        return self.started_us is not None and self.ended_us is None


@dataclass(slots=True, eq=False)
class NodeState:
    """A node's processor and its waiting line.

    Args:
        queue: Tasks that are ready and wait.
        task: Number of the task that runs or has the node reserved.
    """

    queue: CheckedQueue
    task: int | None = None


@dataclass(slots=True, eq=False)
class LinkStates:
    """The links as their transfers see them; lists by link index.

    Args:
        bandwidth_MBps: Clean bandwidth, which never changes.
        flows: Transfers that occupy the link, by number, in order of their start.
        factor: Interference factor while the link is active.
        share_MBps: What each of its flows would get from it (Eq. 1), while it is active.
    """

    bandwidth_MBps: Sequence[float]
    flows: list[dict[int, Transfer]]
    factor: list[float]
    share_MBps: list[float]

    @classmethod
    def idle(cls, bandwidth_MBps: Sequence[float]) -> LinkStates:
        """Return links that nobody uses."""
        count = len(bandwidth_MBps)
        return cls(bandwidth_MBps, [{} for _ in range(count)], [1.0] * count, [0.0] * count)


@dataclass(slots=True, eq=False)
class State:
    """Everything about a run that changes; only the engine writes it.

    Args:
        tasks: All tasks by number.
        transfers: Transfers created so far, by number of their dependency.
        flows: Those that occupy their route, in order of their start.
        nodes: All nodes by index.
        links: All links.
        interference: The model's session of this run, ``None`` if no link affects another.
        queue: What is going to happen.
        watchers: All who watch.
        observers: Those who are told at once.
        log: What the others have not been told of, ``None`` if there are none.
        shows_rates: Whether anybody wants to see rates.
        now_us: The time of the event being handled.
        events: Events handled.
        unfinished_tasks: Tasks that have not ended, of DAGs yet to come too.
        free_tasks_placed: Tasks without a pin that have been placed.
        last_task_end_us: When the latest task ended.
        unroutable: What has no route; ends the run if not empty.
    """

    tasks: list[TaskRun]
    transfers: dict[int, Transfer]
    flows: dict[int, Transfer]
    nodes: list[NodeState]
    links: LinkStates
    interference: CheckedSession | None
    queue: EventQueue
    watchers: tuple[Watcher, ...] = ()
    observers: tuple[Observer, ...] = ()
    log: Log | None = None
    shows_rates: bool = False
    now_us: Instant = 0
    events: int = 0
    unfinished_tasks: int = 0
    free_tasks_placed: int = 0
    last_task_end_us: Instant = 0
    unroutable: list[str] = field(default_factory=list)

    @classmethod
    def of(cls, setup: Setup) -> State:
        """Return the state before the first event."""
        models = setup.models
        who = models.identity("queue_model")
        transfers: dict[int, Transfer] = {}
        return cls(
            tasks=[TaskRun(entry, entry.incoming_count) for entry in setup.tasks],
            transfers=transfers,
            flows={},
            nodes=[
                NodeState(CheckedQueue(asked(who, models.new_queue), who))
                for _ in setup.network.nodes
            ],
            links=LinkStates.idle(setup.bandwidth_MBps),
            interference=session_of(setup),
            queue=EventQueue(transfers),
            unfinished_tasks=len(setup.tasks),
        )

    def served_MB(self) -> list[float]:
        """Return the bytes that each link has carried, credited so far."""
        served_MB = [0.0] * len(self.links.flows)
        for transfer in self.transfers.values():
            carried_MB = transfer.entry.size_MB - transfer.remaining_MB
            for link in transfer.route:
                served_MB[link] += carried_MB
        return served_MB
