"""Hypothesis strategy for whole runs: networks, traffic and interference with every hard case.

Small times and sizes, so that ties on the same microsecond, zero rates, resumed and blocked
transfers, latencies, zero costs and zero sizes all come up.
"""

from dataclasses import dataclass

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from ncsim_core.contracts.interference_model import InterferenceModel
from ncsim_core.engine.observer import Watcher
from ncsim_core.engine.setup import Limits, Reach
from ncsim_core.engine.simulation import Simulation
from ncsim_core.network import Link, LinkId, LinkRates, Network, Node, NodeId
from ncsim_core.testing.toys import ToyRadio, ToyRelays, models
from ncsim_core.workflow import DAG, DagId, Dependency, Injection, Task, TaskId

CAPACITIES = (50.0, 100.0, 300.0)
BANDWIDTHS_MBps = (0.5, 1.0, 2.0, 3.0, 7.7)
LATENCIES_s = (0.0, 0.0, 0.1)
COSTS = (0.0, 50.0, 100.0, 170.0)
TIMES_us = (0, 500_000, 1_000_003)


@dataclass(frozen=True)
class RunCase:
    """Everything that a run is made of.

    Args:
        network: Nodes and links, rates decided.
        injections: What enters when.
        interference: How links slow each other down.
    """

    network: Network
    injections: tuple[Injection, ...]
    interference: InterferenceModel

    def simulation(
        self, *observers: Watcher, limits: Limits | None = None, reach: Reach = Reach.LOCAL
    ) -> Simulation:
        """Return a simulation of it that has not begun."""
        chosen = models(self.network, self.injections, interference=self.interference)
        return Simulation(self.network, chosen, limits, observers, reach=reach)


@st.composite
def run_cases(
    draw: DrawFn, *, max_nodes: int = 6, max_tasks: int = 9, decides_routes: bool = False
) -> RunCase:
    """Return runs on strongly connected networks; most complete, some end blocked.

    With ``decides_routes``, under a model that gives whole routes their rates.
    """
    network = draw(_connected_networks(max_nodes))
    later_us = draw(st.lists(st.sampled_from(TIMES_us), max_size=2))
    injections = tuple(
        Injection(at_us, draw(_pinned_dags(f"d{number}", len(network.nodes), max_tasks)))
        for number, at_us in enumerate(sorted([0, *later_us]))
    )
    if decides_routes:
        relays = ToyRelays(network, stop_at=draw(st.sampled_from([2, 3, 4, 99])))
        return RunCase(network, injections, relays)
    return RunCase(network, injections, draw(_radios(len(network.links))))


@st.composite
def _connected_networks(draw: DrawFn, max_nodes: int) -> Network:
    count = draw(st.integers(2, max_nodes))
    nodes = tuple(Node(NodeId(f"n{k}"), draw(st.sampled_from(CAPACITIES))) for k in range(count))
    ring = [(k, (k + 1) % count) for k in range(count)]
    pairs = [(a, b) for a in range(count) for b in range(count) if a != b]
    chords = draw(st.lists(st.sampled_from(pairs), max_size=10))
    ends = list(dict.fromkeys([*ring, *chords]))
    links = tuple(
        Link(LinkId(f"l{k}"), NodeId(f"n{a}"), NodeId(f"n{b}")) for k, (a, b) in enumerate(ends)
    )
    bandwidths = [draw(st.sampled_from(BANDWIDTHS_MBps)) for _ in links]
    latencies = [draw(st.sampled_from(LATENCIES_s)) for _ in links]
    return Network(nodes, links, LinkRates.of(bandwidths, latencies))


@st.composite
def _pinned_dags(draw: DrawFn, dag_id: str, node_count: int, max_tasks: int) -> DAG:
    count = draw(st.integers(1, max_tasks))
    on = st.integers(0, node_count - 1)
    tasks = tuple(
        Task(TaskId(f"T{k}"), draw(st.sampled_from(COSTS)), NodeId(f"n{draw(on)}"))
        for k in range(count)
    )
    pairs = [(a, b) for b in range(count) for a in range(b)]
    edges = draw(st.lists(st.sampled_from(pairs), max_size=14, unique=True)) if pairs else []
    sizes_MB = st.sampled_from([0.0, 0.5, 1.0, 2.0, 3.0, 10.0]) | st.floats(0.001, 20.0)
    return DAG(
        DagId(dag_id),
        tasks,
        tuple(Dependency(TaskId(f"T{a}"), TaskId(f"T{b}"), draw(sizes_MB)) for a, b in edges),
    )


def _radios(link_count: int) -> SearchStrategy[ToyRadio]:
    indices = st.integers(0, link_count - 1)
    near = st.dictionaries(indices, st.lists(indices, max_size=6), max_size=link_count)
    return st.builds(ToyRadio, near, near, stop_at=st.sampled_from([1, 2, 3, 99]))
