"""HEFT that plans with link rates discounted for the traffic that the radio will let in."""

from typing import Literal, TypeAlias

from ncsim_core.context import BuildContext
from ncsim_core.contracts.scheduler import NetworkSnapshot, Scheduler
from ncsim_core.network import Network, NodeIndex
from ncsim_core.workflow import DAG, PlacementPlan
from typing_extensions import override

from ncsim_wifi.conflict import relations
from ncsim_wifi.propagation import is_on_air, require_positions
from ncsim_wifi.radio import Radio
from ncsim_wifi.schedulers.airtime import (
    conflict_discounts,
    static_airtimes,
    uniform_discounts,
    usable_routes,
)
from ncsim_wifi.schedulers.heft import PlanningNetwork, UNREACHABLE_s_per_MB, heft_plan

Discount: TypeAlias = Literal["conflict_aware", "uniform"]


class DiscountedHeftScheduler(Scheduler):
    """Runs HEFT on route rates min(B_l d_l), with discounts d fixed by network and routes.

    ``conflict_aware``: d_l = 1 / (1 + A_l), A_l the static airtime of the conflict neighbourhood
    of link l. ``uniform``: the mean of these for every link, which tells what caution alone does.
    It sees the conflict graph, unlike the schedulers of the paper's comparison.

    Source: ncsim; a baseline of our own, in no paper.

    Args:
        context: Network and config section ``rf``.
        discount: Which discount to plan with.

    Raises:
        ScenarioError: Wireless links lack positions; all of them are named.
    """

    def __init__(self, context: BuildContext, *, discount: Discount) -> None:
        network = context.network
        on_air = [index for index, link in enumerate(network.links) if is_on_air(link)]
        require_positions(network, on_air, f"scheduler {discount} HEFT")
        self._related = relations(context, Radio.from_section(context.section("rf")))
        self._discount = discount

    @override
    def schedule(self, dag: DAG, snapshot: NetworkSnapshot) -> PlacementPlan:
        return heft_plan(dag, planning_network(snapshot, self.discounts(snapshot)))

    def discounts(self, snapshot: NetworkSnapshot) -> list[float]:
        """Return the factor that each link's bandwidth is planned with."""
        airtimes = static_airtimes(usable_routes(snapshot), snapshot.network)
        discounts = conflict_discounts(airtimes, self._related)
        return discounts if self._discount == "conflict_aware" else uniform_discounts(discounts)


def planning_network(snapshot: NetworkSnapshot, discounts: list[float]) -> PlanningNetwork:
    """Return the network that HEFT plans on."""
    network = snapshot.network
    nodes = range(len(network.nodes))
    return PlanningNetwork(
        [node.id for node in network.nodes],
        [node.compute_capacity for node in network.nodes],
        [[_s_per_MB(snapshot, a, b, discounts) for b in nodes] for a in nodes],
        [[_latency_s(snapshot, network, a, b) for b in nodes] for a in nodes],
    )


def _s_per_MB(
    snapshot: NetworkSnapshot, source: NodeIndex, target: NodeIndex, discounts: list[float]
) -> float:
    if source == target:
        return 0.0
    route = snapshot.routes.route(source, target)
    if not route:
        return UNREACHABLE_s_per_MB
    return max(1.0 / (snapshot.network.bandwidth_MBps[link] * discounts[link]) for link in route)


def _latency_s(
    snapshot: NetworkSnapshot, network: Network, source: NodeIndex, target: NodeIndex
) -> float:
    route = snapshot.routes.route(source, target)
    return network.route_latency_s(route) if route else 0.0
