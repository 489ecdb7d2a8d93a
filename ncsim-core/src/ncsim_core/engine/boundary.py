"""What plug-ins return is checked here, before the engine acts on it.

Every error names the component, its distribution and version, and the value.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TypeVar

from typing_extensions import override

from ncsim_core.contracts.interference_model import Competition, InterferenceSession
from ncsim_core.contracts.queue_model import QueueModel, WaitingTask
from ncsim_core.contracts.scheduler import NetworkSnapshot
from ncsim_core.errors import NcsimError, PlacementError, PluginError
from ncsim_core.models import ComponentIdentity, Models
from ncsim_core.network import LinkIndex, NodeId, NodeIndex
from ncsim_core.workflow import DAG, Injection, PlacementPlan

T = TypeVar("T")

MAX_NAMES_SHOWN = 10


def asked(identity: ComponentIdentity, question: Callable[[], T]) -> T:
    """Return a component's answer; what it raises unforeseen becomes a ``PluginError``."""
    try:
        return question()
    except NcsimError:
        raise
    except Exception as error:
        raise PluginError(f"{identity} raised {type(error).__name__}: {error}") from error


def checked_injections(models: Models) -> tuple[Injection, ...]:
    """Return the DAG source's injections: times in order, ids unique.

    Raises:
        PluginError: They are not.
    """
    who = models.identity("dag_source")
    injections = asked(who, lambda: tuple(models.dag_source.injections()))
    seen: set[str] = set()
    earlier_us = 0
    for injection in injections:
        if not isinstance(injection, Injection):
            raise PluginError(f"{who} gave {injection!r}, which is no Injection")
        if injection.at_us < earlier_us:
            raise PluginError(
                f"{who} injects DAG {injection.dag.id!r} at {injection.at_us} us, "
                f"which is before {earlier_us} us"
            )
        if injection.dag.id in seen:
            raise PluginError(f"{who} injects two DAGs with id {injection.dag.id!r}")
        seen.add(injection.dag.id)
        earlier_us = injection.at_us
    return injections


def checked_placement(models: Models, dag: DAG, snapshot: NetworkSnapshot) -> list[NodeIndex]:
    """Return the node of each task in file order: the scheduler's answer, pins applied.

    Raises:
        PlacementError: The plan lacks a task or names a node that does not exist.
    """
    who = models.identity("scheduler")
    plan: object = asked(who, lambda: models.scheduler.schedule(dag, snapshot))
    if not isinstance(plan, PlacementPlan) or not isinstance(plan.nodes, Mapping):
        raise PlacementError(f"{who} answered with {plan!r} instead of a PlacementPlan")
    lacking = [task.id for task in dag.tasks if task.id not in plan.nodes]
    if lacking:
        shown = ", ".join(map(repr, lacking[:MAX_NAMES_SHOWN]))
        more = f" and {len(lacking) - MAX_NAMES_SHOWN} more" if lacking[MAX_NAMES_SHOWN:] else ""
        raise PlacementError(f"{who} left tasks of DAG {dag.id!r} unplaced: {shown}{more}")
    index = snapshot.network.node_index
    return [
        _known_node(task.pinned_to or plan.nodes[task.id], index, f"{who}: task {task.id!r}")
        for task in dag.tasks
    ]


def _known_node(node: NodeId, index: Mapping[NodeId, NodeIndex], blame: str) -> NodeIndex:
    try:
        return index[node]
    except (KeyError, TypeError):
        raise PlacementError(f"{blame} is placed on unknown node {node!r}") from None


class CheckedSession(InterferenceSession):
    """An interference session whose factors are finite and in [0, 1]."""

    def __init__(self, session: InterferenceSession, who: ComponentIdentity) -> None:
        self._session = session
        self._who = who

    @override
    def update(
        self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]
    ) -> tuple[Sequence[LinkIndex], Sequence[float]]:
        try:
            links, factors = self._session.update(on, off)
        except NcsimError:
            raise
        except Exception as error:
            raise PluginError(f"{self._who} raised {type(error).__name__}: {error}") from error
        for link, factor in zip(links, factors, strict=True):
            if not (math.isfinite(factor) and 0.0 <= factor <= 1.0):
                raise PluginError(f"{self._who} gave link {link} the factor {factor!r}")
        return links, factors

    @override
    def competition(self, links: Sequence[LinkIndex]) -> Sequence[Competition]:
        return asked(self._who, lambda: self._session.competition(links))


class CheckedQueue:
    """The waiting line of one node, from which only waiting tasks come back.

    Args:
        queue: The component's queue.
        who: For messages.
    """

    __slots__ = ("_queue", "_waiting", "_who")

    def __init__(self, queue: QueueModel, who: ComponentIdentity) -> None:
        self._queue = queue
        self._who = who
        self._waiting: set[int] = set()

    def __len__(self) -> int:
        return len(self._waiting)

    def push(self, task: WaitingTask) -> None:
        """Add a task."""
        self._waiting.add(task.ticket)
        asked(self._who, lambda: self._queue.push(task))

    def pop(self) -> WaitingTask:
        """Remove and return the task that the component chooses.

        Raises:
            PluginError: It chose something that does not wait here.
        """
        task: object = asked(self._who, self._queue.pop)
        if not isinstance(task, WaitingTask) or task.ticket not in self._waiting:
            raise PluginError(f"{self._who} popped {task!r}, which does not wait on this node")
        self._waiting.remove(task.ticket)
        return task
