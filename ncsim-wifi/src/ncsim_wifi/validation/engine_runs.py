"""Scenes run through the whole of ncsim: scenario, models, engine."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field

from ncsim_core.api import RunResult, result_of
from ncsim_core.engine.observer import Observer, RateCause, RateChange
from ncsim_core.engine.simulation import Simulation
from ncsim_core.network import Network
from ncsim_core.scenario.assembly import assemble
from ncsim_core.scenario.making import make_scenario
from ncsim_core.units import Instant, s_from_us, us_from_s
from ncsim_core.workflow import DAG, DagId, Dependency, Injection, Task, TaskId
from typing_extensions import override

from ncsim_wifi.validation.scenes import Flow, Scene

SOLO = {"type": "wifi", "options": {"rate": "solo"}}
RAW_PHY = {"type": "wifi", "options": {"rate": "raw_phy"}}
FIXED_CAPTURE = {"type": "csma_bianchi", "options": {"hidden_model": "fixed_capture"}}


class RateLog(Observer):
    """Keeps the rate of every transfer over time."""

    def __init__(self) -> None:
        self._changes: dict[int, list[tuple[float, float]]] = {}

    @override
    def rates_assigned(
        self, at_us: Instant, cause: RateCause, changes: Sequence[RateChange]
    ) -> None:
        for change in changes:
            entry = (s_from_us(at_us), change.rate_MBps)
            self._changes.setdefault(change.transfer, []).append(entry)

    @override
    def transfer_ended(self, at_us: Instant, transfer: int) -> None:
        self._changes.setdefault(transfer, []).append((s_from_us(at_us), 0.0))

    def mean_rate_MBps(self, transfer: int, start_s: float, end_s: float) -> float:
        """Return what a transfer got per second in a window."""
        served_MB, at_s, rate_MBps = 0.0, start_s, 0.0
        for change_s, new_MBps in self._changes.get(transfer, []):
            until_s = min(max(change_s, start_s), end_s)
            served_MB += rate_MBps * (until_s - at_s)
            at_s, rate_MBps = until_s, new_MBps
        return (served_MB + rate_MBps * (end_s - at_s)) / (end_s - start_s)

    def first_rate_MBps(self, transfer: int, at_s: float = 0.0) -> float:
        """Return what a transfer gets once everything that starts at a time has started."""
        rates = [rate for when_s, rate in self._changes.get(transfer, []) if when_s <= at_s]
        return rates[-1] if rates else 0.0


@dataclass(frozen=True)
class Measured:
    """What a scene came to in the engine.

    Args:
        result: The run's result.
        flows: What was to be transferred.
        rates: Rates over time; transfers are numbered as flows in order of start.
    """

    result: RunResult
    flows: tuple[Flow, ...]
    rates: RateLog = field(default_factory=RateLog)

    def end_s(self, flow: int) -> float:
        """Return when a flow ended; infinite if it did not."""
        for transfer in self.result.transfers:
            if transfer.dag == _dag_id(flow) and transfer.ended_s is not None:
                return transfer.ended_s
        return float("inf")

    def mean_rate_MBps(self, flow: int) -> float:
        """Return size over duration of a flow, 0 if it never ended."""
        each = self.flows[flow]
        return each.size_MB / (self.end_s(flow) - each.start_s)


def measure(
    scene: Scene,
    interference: Mapping[str, object] | str = "csma_bianchi",
    link_model: Mapping[str, object] = SOLO,
) -> Measured:
    """Return what a scene comes to in the engine."""
    network = scene.network()
    config = {
        "scheduler": "manual",
        "routing": "direct",
        "link_model": dict(link_model),
        "interference": interference,
        "rf": asdict(scene.radio),
    }
    injections = [_injection(number, flow, network) for number, flow in enumerate(scene.flows)]
    assembly = assemble(make_scenario("validation", network, injections, config))
    rates = RateLog()
    simulation = Simulation(assembly.network, assembly.models, observers=[rates])
    simulation.run()
    return Measured(result_of(simulation), scene.flows, rates)


def _injection(number: int, flow: Flow, network: Network) -> Injection:
    """Return a DAG with one dependency between two tasks that take no time."""
    link = network.links[flow.link]
    source, target = TaskId("source"), TaskId("target")
    tasks = (Task(source, 0.0, link.source), Task(target, 0.0, link.target))
    dag = DAG(_dag_id(number), tasks, (Dependency(source, target, flow.size_MB),))
    return Injection(us_from_s(flow.start_s), dag)


def _dag_id(flow: int) -> DagId:
    return DagId(f"flow{flow}")
