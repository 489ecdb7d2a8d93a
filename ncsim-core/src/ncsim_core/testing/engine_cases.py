"""Hypothesis strategy for scenarios that the engine is compared on: every ending, every tie.

Few draws, decoded by plain functions (``drawing.py``).
"""

from collections.abc import Sequence
from typing import Final, NamedTuple, TypeAlias

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn
from typing_extensions import override

from ncsim_core.builtin.queue_models import FifoQueue
from ncsim_core.context import BuildContext
from ncsim_core.contracts.interference_model import InterferenceModel
from ncsim_core.contracts.queue_model import QueueModel, WaitingTask
from ncsim_core.contracts.scheduler import NetworkSnapshot, Scheduler
from ncsim_core.engine.setup import Limits
from ncsim_core.models import Models
from ncsim_core.network import Link, LinkId, LinkIndex, Network, Node, NodeId
from ncsim_core.testing.builders import rated
from ncsim_core.testing.drawing import Digits, drawn_codes
from ncsim_core.testing.toys import TabledRadio, ToyRadio, ToyRelays, models
from ncsim_core.workflow import DAG, DagId, Dependency, Injection, PlacementPlan, Task, TaskId

# Values that meet: 1 us, 1 s and 1/3 s come about in several ways, so that ends coincide.
CAPACITIES: Final = (100.0, 100.0, 50.0, 300.0)
COSTS: Final = (100.0, 50.0, 0.0, 1e-4, 200.0, 70.0)
SIZES_MB: Final = (10.0, 5.0, 0.0, 1e-5, 2.5, 7.0, 20.0)
BANDWIDTHS_MBps: Final = (10.0, 10.0, 5.0, 3.0, 20.0)
LATENCIES_s: Final = (0.0, 0.0, 0.0, 1e-6, 0.25, 0.5)
TIMES_us: Final = (0, 0, 1, 250_000, 1_000_000, 1_500_000)
ONE_IN_EIGHT: Final = (*[False] * 7, True)
ONE_IN_TWELVE: Final = (*[False] * 11, True)
LIMITS: Final = st.sampled_from(
    (*[Limits()] * 13, Limits(max_events=40), Limits(max_time_us=0), Limits(max_time_us=1_100_000))
)


class EngineCase(NamedTuple):
    """A network, who decides in a run on it, and when to give up."""

    network: Network
    models: Models
    limits: Limits


class EmptiestNode(Scheduler):
    """Asks for everything that a snapshot tells of a run under way."""

    @override
    def schedule(self, dag: DAG, snapshot: NetworkSnapshot) -> PlacementPlan:
        busy = list(snapshot.queue_depths)
        for transfer in snapshot.active_transfers:
            busy[transfer.target] += 1
        plan: dict[TaskId, NodeId] = {}
        for task in dag.tasks:
            node = busy.index(min(busy))
            busy[node] += 1
            plan[task.id] = snapshot.network.nodes[node].id
        return PlacementPlan(plan)


class LastInFirstOut(QueueModel):
    """Serves who came last."""

    def __init__(self, context: BuildContext) -> None:
        del context
        self._tasks: list[WaitingTask] = []

    @override
    def push(self, task: WaitingTask) -> None:
        self._tasks.append(task)

    @override
    def pop(self) -> WaitingTask:
        return self._tasks.pop()

    @override
    def __len__(self) -> int:
        return len(self._tasks)


def network_from(node_codes: Sequence[int], link_codes: Sequence[int]) -> Network:
    """Return a tree, mostly both ways and mostly usable, and some links more."""
    nodes = [
        Node(NodeId(f"n{k}"), Digits(code).pick(CAPACITIES)) for k, code in enumerate(node_codes)
    ]
    links: list[Link] = []

    def connect(digits: Digits, source: int, target: int) -> None:
        bandwidth = 0.0 if digits.pick(ONE_IN_TWELVE) else digits.pick(BANDWIDTHS_MBps)
        name, ends = f"l{len(links)}", (nodes[source].id, nodes[target].id)
        links.append(Link(LinkId(name), *ends, bandwidth, digits.pick(LATENCIES_s)))

    for number, digits in enumerate(map(Digits, node_codes[1:]), 1):
        other = digits.pick(range(number))
        connect(digits, other, number)
        if not digits.pick(ONE_IN_EIGHT):
            connect(digits, number, other)
    pairs = [(a, b) for a in range(len(nodes)) for b in range(len(nodes)) if a != b]
    for digits in map(Digits, link_codes):
        connect(digits, *digits.pick(pairs))
    return rated(Network(tuple(nodes), tuple(links)))


def radio_from(codes: Sequence[int], link_count: int, *, is_tabled: bool = False) -> ToyRadio:
    """Return a radio on which links slow, disturb and stall each other, some one way only."""
    neighbours: dict[LinkIndex, set[LinkIndex]] = {link: set() for link in range(link_count)}
    hidden: dict[LinkIndex, set[LinkIndex]] = {link: set() for link in range(link_count)}
    stop_at = 99
    for digits in map(Digits, codes):
        a, b = digits.pick(range(link_count)), digits.pick(range(link_count))
        table = digits.pick((neighbours, neighbours, hidden))
        table[a].add(b)
        if digits.pick((True, True, False)):
            table[b].add(a)
        stop_at = digits.pick((99, 99, 3, 2, 1))
    if is_tabled:
        return TabledRadio(link_count, neighbours, hidden, stop_at=stop_at)
    return ToyRadio(neighbours, hidden, stop_at=stop_at)


DagCodes: TypeAlias = tuple[int, list[int], list[int]]


def injection_from(number: int, codes: DagCodes, ids: Sequence[NodeId]) -> Injection:
    """Return a DAG whose tasks are all pinned, or some, or none."""
    time_code, task_codes, edge_codes = codes
    kinds_of_pins: tuple[list[NodeId | None], ...] = ([*ids], [*ids], [*ids, None], [None])
    pins = Digits(time_code // len(TIMES_us)).pick(kinds_of_pins)
    drawn = [Digits(code) for code in task_codes]
    names = [TaskId(f"t{k}") for k in range(len(drawn))]  # "t10" comes before "t2"
    tasks = tuple(
        Task(name, digits.pick(COSTS), digits.pick(pins))
        for name, digits in zip(names, drawn, strict=True)
    )
    sizes_MB: dict[tuple[TaskId, TaskId], float] = {}
    for digits in map(Digits, edge_codes if len(names) > 1 else ()):
        target = digits.pick(range(1, len(names)))
        source = max(0, target - 1 - digits.pick(range(6)))
        sizes_MB[names[source], names[target]] = digits.pick(SIZES_MB)
    edges = tuple(Dependency(*ends, size_MB) for ends, size_MB in sizes_MB.items())
    return Injection(Digits(time_code).pick(TIMES_us), DAG(DagId(f"d{number}"), tasks, edges))


@st.composite
def dag_codes(draw: DrawFn) -> DagCodes:
    """Return numbers that mean a small DAG or one of up to 30 tasks."""
    small = draw(st.booleans())
    tasks = draw(drawn_codes(1, 5) if small else drawn_codes(6, 30))
    return draw(st.integers(0, 2**16)), tasks, draw(drawn_codes(len(tasks) // 2, 2 * len(tasks)))


@st.composite
def engine_cases(draw: DrawFn, *, is_compilable: bool = False) -> EngineCase:
    """Return 2 to 12 nodes, up to four DAGs of up to 30 tasks, and a radio between the links.

    Args:
        draw: Given by hypothesis.
        is_compilable: Only models and queues that the compiled loop knows.
    """
    network = network_from(draw(drawn_codes(2, 4) | drawn_codes(5, 12)), draw(drawn_codes(0, 12)))
    ids = [node.id for node in network.nodes]
    listed = draw(st.lists(dag_codes(), min_size=1, max_size=4))
    injections = [injection_from(number, codes, ids) for number, codes in enumerate(listed)]
    radio = draw(_compilable_radios(network) if is_compilable else _radios(network))
    scheduler = draw(st.sampled_from((None, None, EmptiestNode())))
    unusual = FifoQueue if is_compilable else LastInFirstOut
    who = models(
        network,
        injections,
        scheduler=scheduler,
        interference=radio,
        queue=draw(st.sampled_from((FifoQueue, FifoQueue, FifoQueue, unusual))),
    )
    return EngineCase(network, who, draw(LIMITS))


@st.composite
def _radios(draw: DrawFn, network: Network) -> InterferenceModel:
    if draw(st.sampled_from(ONE_IN_EIGHT)):
        return ToyRelays(network, stop_at=draw(st.sampled_from((99, 99, 2, 3))))
    codes = draw(drawn_codes(0, 6) | drawn_codes(10, 40))
    return radio_from(codes, len(network.links), is_tabled=draw(st.booleans()))


@st.composite
def _compilable_radios(draw: DrawFn, network: Network) -> InterferenceModel | None:
    codes = draw(st.none() | drawn_codes(1, 6) | drawn_codes(10, 40))
    return None if codes is None else radio_from(codes, len(network.links), is_tabled=True)
