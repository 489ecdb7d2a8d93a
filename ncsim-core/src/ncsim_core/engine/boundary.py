"""What plug-ins return is checked here, before the engine acts on it.

Every error names the component, its distribution and version, and the value.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from numbers import Integral
from typing import TYPE_CHECKING, SupportsFloat, TypeVar

from typing_extensions import override

from ncsim_core.builtin.queue_models import FifoQueue
from ncsim_core.contracts.interference_model import (
    Against,
    Competition,
    InterferenceSession,
    RouteRates,
)
from ncsim_core.contracts.queue_model import QueueModel, WaitingTask
from ncsim_core.contracts.scheduler import NetworkSnapshot
from ncsim_core.errors import NcsimError, PlacementError, PluginError, some_of, told
from ncsim_core.models import ComponentIdentity, Models
from ncsim_core.network import LinkIndex, Network, NodeId, NodeIndex, Route
from ncsim_core.workflow import DAG, Injection, PlacementPlan

if TYPE_CHECKING:
    from ncsim_core.engine.sessions.tabled_session import TabledSession

T = TypeVar("T")

MAX_NAMES_SHOWN = 10

RATE_TOLERANCE = 1e-9
"""Part of its clean bandwidth that a link may seem to carry beyond it, by rounding."""


def asked(identity: ComponentIdentity, question: Callable[[], T]) -> T:
    """Return a component's answer; what it raises unforeseen becomes a ``PluginError``."""
    try:
        return question()
    except NcsimError:
        raise
    except (Exception, SystemExit) as error:
        raise PluginError(f"{identity} raised {told(error)}") from error


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
        PlacementError: The plan lacks a task, or names a task or a node that does not exist.
    """
    who = models.identity("scheduler")
    plan: object = asked(who, lambda: models.scheduler.schedule(dag, snapshot))
    if not isinstance(plan, PlacementPlan) or not isinstance(plan.nodes, Mapping):
        raise PlacementError(f"{who} answered with {plan!r} instead of a PlacementPlan")
    if not plan.nodes.keys() >= dag.task_index.keys():
        lacking = [repr(task.id) for task in dag.tasks if task.id not in plan.nodes]
        shown = some_of(lacking, MAX_NAMES_SHOWN)
        raise PlacementError(f"{who} left tasks of DAG {dag.id!r} unplaced: {shown}")
    if len(plan.nodes) > len(dag.task_index):
        strangers = sorted(str(task) for task in plan.nodes if task not in dag.task_index)
        shown = some_of([*map(repr, strangers)], MAX_NAMES_SHOWN)
        raise PlacementError(f"{who} placed what is no task of DAG {dag.id!r}: {shown}")
    index, nodes = snapshot.network.node_index, plan.nodes
    try:
        return [index[task.pinned_to or nodes[task.id]] for task in dag.tasks]
    except (KeyError, TypeError):
        raise PlacementError(f"{who}: {_misplaced(plan, dag, index)}") from None


def _misplaced(plan: PlacementPlan, dag: DAG, index: Mapping[NodeId, NodeIndex]) -> str:
    """Return which task is placed on a node that does not exist."""
    known = [*index]  # a node may be something without a hash
    task, node = next(
        (task, node)
        for task in dag.tasks
        if (node := task.pinned_to or plan.nodes[task.id]) not in known
    )
    return f"task {task.id!r} is placed on unknown node {node!r}"


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
            wrong = [
                (link, factor)
                for link, factor in zip(links, factors, strict=True)
                if not (math.isfinite(factor) and 0.0 <= factor <= 1.0)
            ]
        except NcsimError:
            raise
        except (Exception, SystemExit) as error:
            raise PluginError(f"{self._who} raised {told(error)}") from error
        if wrong:
            link, factor = wrong[0]
            raise PluginError(f"{self._who} gave link {link} the factor {factor!r}, not 0 to 1")
        return links, factors

    @override
    def competition(self, links: Sequence[LinkIndex]) -> Sequence[Competition]:
        answers = asked(self._who, lambda: list(self._session.competition(links)))
        if len(answers) != len(links):
            count = f"{len(answers)} answers for {len(links)} links"
            raise PluginError(f"{self._who}: competition() gave {count}")
        for answer in answers:
            if not _is_competition(answer):
                raise PluginError(f"{self._who}: competition() gave {answer!r}")
        return answers

    def against(self, links: Sequence[LinkIndex]) -> Against:
        """Return what each of ``links``, at least one, is up against now, as columns."""
        contenders, hidden, factors = zip(*self.competition(links), strict=True)
        return contenders, hidden, factors


def _is_competition(answer: object) -> bool:
    """Return whether an answer holds two counts and a factor."""
    if not isinstance(answer, Competition):
        return False
    fields: Sequence[object] = answer
    *counts, factor = fields
    are_counts = all(isinstance(count, Integral) and int(count) >= 0 for count in counts)
    return are_counts and _is_factor(factor)


def _is_factor(number: object) -> bool:
    return isinstance(number, SupportsFloat) and 0.0 <= float(number) <= 1.0


class CheckedTables(CheckedSession):
    """A session of the engine's own on a model's tables, which have been checked as a whole."""

    def __init__(self, session: "TabledSession", who: ComponentIdentity) -> None:
        super().__init__(session, who)
        self.against = session.against  # type: ignore[method-assign]  # without a call in between


def checked_route_rates(
    models: Models, routes: Sequence[Route], network: Network
) -> list[tuple[float, LinkIndex]]:
    """Return rate in MB/s and bottleneck of each route, as the interference model decides.

    Raises:
        PluginError: A rate is no ordinary number or above what links carry, or a bottleneck is
            not on its route.
    """
    who = models.identity("interference_model")
    answers = asked(who, lambda: _route_answers(models.interference.route_rates(routes)))
    fault = route_rates_fault(routes, *answers, network)
    if fault is not None:
        raise PluginError(f"{who} {fault}")
    return list(zip(*answers, strict=True))


def route_rates_fault(
    routes: Sequence[Route],
    rates_MBps: Sequence[float],
    bottlenecks: Sequence[LinkIndex],
    network: Network,
) -> str | None:
    """Return what is wrong with the rates of routes, ``None`` if nothing is.

    Each rate is finite and 0 or more, each bottleneck is on its route, and no link carries more
    than its clean bandwidth, so that no route does either.
    """
    if not len(routes) == len(rates_MBps) == len(bottlenecks):
        counts = f"{len(rates_MBps)} rates and {len(bottlenecks)} bottlenecks"
        return f"gave {counts} for {len(routes)} routes"
    carried_MBps: dict[LinkIndex, float] = {}
    for route, rate_MBps, bottleneck in zip(routes, rates_MBps, bottlenecks, strict=True):
        if not (math.isfinite(rate_MBps) and rate_MBps >= 0.0):
            return f"gave route {list(route)} the rate {rate_MBps!r} MB/s"
        if bottleneck not in route:
            return f"gave route {list(route)} the bottleneck {bottleneck!r}, which is not on it"
        for link in route:
            carried_MBps[link] = carried_MBps.get(link, 0.0) + rate_MBps
    for link, total_MBps in carried_MBps.items():
        clean_MBps = network.bandwidth_MBps[link]
        if total_MBps > clean_MBps * (1 + RATE_TOLERANCE):
            name = network.links[link].id
            return f"lets link {name!r} of {clean_MBps!r} MB/s carry {total_MBps!r} MB/s"
    return None


def _route_answers(rates: RouteRates) -> tuple[list[float], list[LinkIndex]]:
    rates_MBps, bottlenecks = rates
    return [float(each) for each in rates_MBps], [int(each) for each in bottlenecks]


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

    @property
    def is_first_in_first_out(self) -> bool:
        """Return whether the component is known to do no more than that."""
        return type(self._queue) is FifoQueue

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
