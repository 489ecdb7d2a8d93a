"""Where does each task run?"""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

from ncsim_core.contracts.routing_model import RouteTable
from ncsim_core.network import Network, NodeIndex
from ncsim_core.workflow import DAG, DagId, PlacementPlan, TaskId


@dataclass(frozen=True, slots=True)
class ActiveTransfer:
    """A dependency that is on its way while a plan is made.

    Args:
        dag_id: DAG of the dependency.
        source_task: Task that produced the data.
        target_task: Task that waits for it.
        source: Node that sends.
        target: Node that receives.
        remaining_MB: Bytes not yet served.
    """

    dag_id: DagId
    source_task: TaskId
    target_task: TaskId
    source: NodeIndex
    target: NodeIndex
    remaining_MB: float


@dataclass(frozen=True)
class NetworkSnapshot:
    """What a scheduler may see: no conflict graph, no contention factor.

    Args:
        network: Nodes with their capacities and links with clean bandwidths.
        routes: The route a transfer between two nodes would take.
        now_s: Time of the injection.
        queue_depths: Waiting tasks per node, the running one included.
        active_transfers: Transfers under way.
        free_tasks_placed: Tasks without a pin that earlier injections have placed.
    """

    network: Network
    routes: RouteTable
    now_s: float = 0.0
    queue_depths: tuple[int, ...] = ()
    active_transfers: tuple[ActiveTransfer, ...] = ()
    free_tasks_placed: int = 0

    def bottleneck_MBps(self, source: NodeIndex, target: NodeIndex) -> float:
        """Return the clean bottleneck bandwidth of the route between two nodes.

        Infinite for a node with itself, 0 when there is no usable route.
        """
        route = self.routes.route(source, target)
        return 0.0 if route is None else self.network.route_bottleneck_MBps(route)

    def transfer_time_s(self, size_MB: float, source: NodeIndex, target: NodeIndex) -> float:
        """Return latency plus size over bottleneck: the time of a transfer that is alone.

        Infinite when there is no usable route.
        """
        if source == target:
            return 0.0
        route = self.routes.route(source, target)
        if route is None:
            return math.inf
        bottleneck_MBps = self.network.route_bottleneck_MBps(route)
        return self.network.route_latency_s(route) + size_MB / bottleneck_MBps


class Scheduler(ABC):
    """Decides the node of every task of a DAG when the DAG is injected."""

    @abstractmethod
    def schedule(self, dag: DAG, snapshot: NetworkSnapshot) -> PlacementPlan:
        """Return a plan with every task of ``dag`` on an existing node.

        Pins (``Task.pinned_to``) override the answer afterwards; a scheduler may use them
        to plan better. Neither argument may be changed.

        Raises:
            ScenarioError: The scheduler needs something that the scenario does not give.
        """
