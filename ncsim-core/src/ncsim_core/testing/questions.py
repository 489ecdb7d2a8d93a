"""What each kind of component is asked in checks, and its answer as plain, comparable data.

Free of hypothesis and pytest, because a child process asks the same questions under another
hash seed.
"""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, TypeAlias, cast

from ncsim_core.contracts.dag_source import DAGSource
from ncsim_core.contracts.interference_model import InterferenceModel
from ncsim_core.contracts.link_model import LinkModel
from ncsim_core.contracts.queue_model import QueueModel, WaitingTask
from ncsim_core.contracts.routing_model import RoutingModel
from ncsim_core.contracts.scheduler import Scheduler
from ncsim_core.network import LinkId, LinkIndex, Network, Route
from ncsim_core.testing import builders
from ncsim_core.testing.builders import make_snapshot
from ncsim_core.testing.oracle import FewestHops
from ncsim_core.workflow import DAG, DagId, Injection, PlacementPlan, TaskId

Answer: TypeAlias = object


@dataclass(frozen=True)
class Case:
    """One question to one component.

    Args:
        network: The network it is built on.
        dag: For schedulers: what to place.
        active: For interference models: links in use.
        toggles: For interference models: links to switch on or off, one after another.
        routes: For interference models that decide routes: routes in use, ascending.
        waiting: For queue models: tasks to push; ``None`` stands for a pop.
        injections: For DAG sources: what the scenario lists.
    """

    network: Network
    dag: DAG | None = None
    active: tuple[LinkIndex, ...] = ()
    toggles: tuple[LinkIndex, ...] = ()
    routes: tuple[Route, ...] = ()
    waiting: tuple[WaitingTask | None, ...] = ()
    injections: tuple[Injection, ...] = ()

    @property
    def usable_routes(self) -> tuple[Route, ...]:
        """Return the routes whose links all have bandwidth; for networks with rates."""
        bandwidth_MBps = self.network.bandwidth_MBps
        return tuple(
            route for route in self.routes if all(bandwidth_MBps[link] > 0 for link in route)
        )

    def with_network(self, network: Network) -> "Case":
        """Return the same question about another network."""
        return replace(self, network=network)


def ask_scheduler(component: object, case: Case) -> Answer:
    """Return the plan as pairs of task and node, in task order."""
    assert case.dag is not None
    plan: object = cast("Scheduler", component).schedule(case.dag, make_snapshot(case.network))
    assert isinstance(plan, PlacementPlan), f"schedule() gave {plan!r}, not a PlacementPlan"
    return sorted(plan.nodes.items())


def ask_routing_model(component: object, case: Case) -> Answer:
    """Return all routes, row by row."""
    model = cast("RoutingModel", component)
    nodes = range(len(case.network.nodes))
    return [[model.route(a, b, case.network) for b in nodes] for a in nodes]


def ask_link_model(component: object, case: Case) -> Answer:
    """Return bandwidths and latencies."""
    rates = cast("LinkModel", component).rate_links(case.network)
    return (rates.bandwidth_MBps, rates.latency_s)


def ask_interference_model(component: object, case: Case) -> Answer:
    """Return factors, reach and competition of the active links, and the rates of routes."""
    model = cast("InterferenceModel", component)
    factors: object = model.factors(case.active, case.active)
    assert isinstance(factors, Iterable), f"factors() gave {factors!r}, not an array of numpy"
    reach: object = model.reach(case.active)
    assert isinstance(reach, Collection), f"reach() gave {reach!r}, not a collection of links"
    return (
        [float(each) for each in factors],
        sorted(reach),
        [tuple(each) for each in model.competition(case.active, case.active)],
        route_answers(model, case.usable_routes) if model.decides_routes else [],
    )


def route_answers(
    model: InterferenceModel, routes: Sequence[Route]
) -> list[tuple[float, LinkIndex]]:
    """Return rate in MB/s and bottleneck of each route."""
    if not routes:
        return []
    rates_MBps, bottlenecks = model.route_rates(routes)
    return list(zip(map(float, rates_MBps), map(int, bottlenecks), strict=True))


def ask_queue_model(component: object, case: Case) -> Answer:
    """Return what comes out of pushes and pops, and then until the queue is empty."""
    queue = cast("QueueModel", component)
    popped: list[WaitingTask] = []
    for task in case.waiting:
        if task is not None:
            queue.push(task)
        elif len(queue):
            popped.append(queue.pop())
    popped += [queue.pop() for _ in range(len(queue))]
    return popped


def ask_dag_source(component: object, case: Case) -> Answer:
    """Return the injections; the case was told when the source was built."""
    del case
    return list(cast("DAGSource", component).injections())


ASK: Final[Mapping[str, Callable[[object, Case], Answer]]] = {
    "scheduler": ask_scheduler,
    "routing_model": ask_routing_model,
    "link_model": ask_link_model,
    "interference_model": ask_interference_model,
    "queue_model": ask_queue_model,
    "dag_source": ask_dag_source,
}


def fixed_cases(kind: str) -> list[Case]:
    """Return a few ordinary questions, always the same, for what is too slow to draw."""
    capacities = (100.0, 250.0, 75.0, 180.0, 60.0)
    networks = [
        builders.line(4, capacities=capacities, latency_s=0.01),
        builders.grid(2, 3, capacities=capacities, bandwidth_MBps=4.0),
        _with_parallel_links(builders.star(4, capacities=capacities)),
    ]
    if kind == "dag_source":
        injections = tuple(builders.inject(builders.chain(2, dag_id=f"d{k}"), k) for k in (2, 0, 1))
        return [Case(networks[0], injections=some) for some in (injections, injections[:1])]
    if kind == "queue_model":
        return [Case(networks[0], waiting=tuple(_tasks_in_mixed_order()))]
    if kind == "interference_model":
        return [
            Case(each, active=tuple(range(0, len(each.links), 2)), routes=_routes(each))
            for each in networks
        ]
    if kind == "scheduler":
        pins = {k: k % 4 for k in range(6)}
        return [
            *(Case(each, dag=builders.fork_join(8, cost=150.0)) for each in networks),
            Case(networks[0], dag=builders.fork_join(4, pins=pins)),
            Case(networks[0], dag=builders.chain(3, cost=150.0)),
        ]
    return [Case(each) for each in networks]


def _routes(network: Network) -> tuple[Route, ...]:
    """Return some of the shortest routes, the last of them twice."""
    last = len(network.nodes) - 1
    ends = [(a, b) for a in (0, 1) for b in (last, 2, 0) if a != b]
    found = [FewestHops().route(a, b, network) for a, b in ends]
    routes = [route for route in found if route]
    return tuple(sorted([*routes, *routes[-1:]]))


def _with_parallel_links(network: Network) -> Network:
    """Return the network with every link doubled, so that ties abound."""
    twins = tuple(replace(each, id=LinkId(f"{each.id}_twin")) for each in network.links)
    return builders.rated(Network(network.nodes, network.links + twins))


def _tasks_in_mixed_order() -> list[WaitingTask | None]:
    costs = (30.0, 10.0, 20.0, 10.0, 30.0)
    tasks = [
        WaitingTask(DagId(f"d{k % 2}"), TaskId(f"T{k}"), cost, ready_us=k // 2, ticket=k)
        for k, cost in enumerate(costs)
    ]
    return [*tasks[:3], None, *tasks[3:], None]


def reversed_links(network: Network) -> Network:
    """Return the same network with its links listed backwards, rates and all."""
    turned = Network(network.nodes, network.links[::-1])
    if network.rates is None:
        return turned
    rates = network.rates
    return turned.with_rates(
        replace(rates, bandwidth_MBps=rates.bandwidth_MBps[::-1], latency_s=rates.latency_s[::-1])
    )
