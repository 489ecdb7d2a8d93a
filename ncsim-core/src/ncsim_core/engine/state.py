"""What is happening: everything about a run that changes."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING

from ncsim_core.contracts.interference_model import InterferenceSession, PlainSession
from ncsim_core.engine.boundary import CheckedQueue, CheckedSession, asked
from ncsim_core.engine.event_queue import EventQueue
from ncsim_core.engine.links_in_use import LinksInUse
from ncsim_core.engine.setup import DependencyEntry, Reach, Setup, TaskEntry

if TYPE_CHECKING:
    from ncsim_core.engine.events import Event
    from ncsim_core.engine.observer import Observer
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
        entry: The dependency.
        route: The links it occupies, fixed when it was created.
        remaining_MB: Bytes not served up to ``credited_us``.
        created_us: When its producer ended; latency is paid from here.
        credited_us: Up to when service has been credited.
        rate_MBps: Service rate since then; 0 means that it is paused.
        bottleneck: First link of the route with the least share.
        completion: Ticket of its completion event, ``None`` while paused.
        started_us: When byte service began.
        ended_us: When the last byte was served.
    """

    entry: DependencyEntry
    route: Route
    remaining_MB: float
    created_us: Instant
    credited_us: Instant = 0
    rate_MBps: float = 0.0
    bottleneck: LinkIndex = -1
    completion: int | None = None
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
        task: The task that runs or has the node reserved.
    """

    queue: CheckedQueue
    task: TaskRun | None = None


@dataclass(slots=True, eq=False)
class LinkState:
    """A link as its transfers see it.

    Args:
        flows: Transfers that occupy it, by number, in order of their start.
        factor: Interference factor while it is active.
        share_MBps: What each of its flows would get from it (Eq. 1).
        served_MB: Bytes it has carried, credited so far.
    """

    flows: dict[int, Transfer] = field(default_factory=dict)
    factor: float = 1.0
    share_MBps: float = 0.0
    served_MB: float = 0.0


@dataclass(slots=True, eq=False)
class State:
    """Everything about a run that changes; only the engine writes it.

    Args:
        tasks: All tasks by number.
        transfers: Transfers created so far, by number of their dependency.
        flows: Those that occupy their route, in order of their start.
        nodes: All nodes by index.
        links: All links by index.
        interference: The model's session of this run.
        queue: What is going to happen.
        observers: Who watches.
        rate_observers: Those who want to see rates.
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
    links: list[LinkState]
    interference: InterferenceSession
    queue: EventQueue[Event]
    observers: tuple[Observer, ...] = ()
    rate_observers: tuple[Observer, ...] = ()
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
        who_queues = models.identity("queue_model")
        who_interferes = models.identity("interference_model")
        session = asked(who_interferes, lambda: _session(setup))
        return cls(
            tasks=[TaskRun(entry, entry.incoming_count) for entry in setup.tasks],
            transfers={},
            flows={},
            nodes=[
                NodeState(CheckedQueue(asked(who_queues, models.new_queue), who_queues))
                for _ in setup.network.nodes
            ],
            links=[LinkState() for _ in setup.network.links],
            interference=CheckedSession(session, who_interferes),
            queue=EventQueue(),
            unfinished_tasks=len(setup.tasks),
        )


def _session(setup: Setup) -> InterferenceSession:
    if setup.models.interference.decides_routes:
        return LinksInUse(setup.models.interference)
    if setup.reach is Reach.GLOBAL:
        return PlainSession(setup.models.interference, is_global=True)
    return setup.models.interference.open_session()
