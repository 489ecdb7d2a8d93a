"""A scenario in, a result out: the Python interface to one run.

>>> from ncsim_core import load_scenario, simulate
>>> scenario = load_scenario("examples/two_hop.yaml")  # doctest: +SKIP
>>> simulate(scenario, interference="none").makespan_s  # doctest: +SKIP
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ncsim_core.engine.accompanying import accompanied
from ncsim_core.engine.outcome import RunStatus
from ncsim_core.engine.simulation import Simulation
from ncsim_core.scenario.assembly import assemble
from ncsim_core.scenario.loader import load_scenario, parse_scenario
from ncsim_core.scenario.model import Scenario
from ncsim_core.units import s_from_us

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    import pandas as pd

    from ncsim_core.engine.observer import Watcher
    from ncsim_core.engine.setup import Limits
    from ncsim_core.engine.state import TaskRun, Transfer
    from ncsim_core.units import Instant


class TaskResult(NamedTuple):
    """What became of a task; times in seconds, ``None`` for what did not happen."""

    dag: str
    task: str
    node: str | None
    status: str
    ready_s: float | None
    started_s: float | None
    ended_s: float | None


class TransferResult(NamedTuple):
    """What became of a dependency between two nodes.

    ``created_s`` is when its producer ended, ``started_s`` when latency was paid and byte
    service began; ``None`` for what did not happen.
    """

    dag: str
    source_task: str
    target_task: str
    size_MB: float
    route: tuple[str, ...]
    created_s: float
    started_s: float | None
    ended_s: float | None
    remaining_MB: float


class LinkResult(NamedTuple):
    """What a link carried."""

    link: str
    bandwidth_MBps: float
    served_MB: float


@dataclass(frozen=True)
class RunResult:
    """How a run ended and what happened in it.

    Args:
        status: Why it stopped.
        makespan_s: When the last task ended; ``None`` unless the run completed.
        detail: What to know about an end other than ``completed``.
        ended_s: Time of the last event.
        events: Events handled.
        tasks: All tasks, in order of injection and file.
        transfers: All transfers, in order of creation.
        links: All links in file order.
    """

    status: RunStatus
    makespan_s: float | None
    detail: str
    ended_s: float
    events: int
    tasks: tuple[TaskResult, ...]
    transfers: tuple[TransferResult, ...]
    links: tuple[LinkResult, ...]

    @property
    def remote_MB(self) -> float:
        """Return the payload of all dependencies that crossed nodes."""
        return sum(transfer.size_MB for transfer in self.transfers)

    @property
    def route_work_MB_hops(self) -> float:
        """Return the payload times the number of links it used, over all transfers."""
        return sum(transfer.size_MB * len(transfer.route) for transfer in self.transfers)

    @property
    def placement(self) -> dict[tuple[str, str], str]:
        """Return the node of each placed task, by DAG and task id."""
        return {(task.dag, task.task): task.node for task in self.tasks if task.node is not None}

    def to_dict(self) -> dict[str, object]:
        """Return everything as plain lists and dictionaries, ready for JSON."""
        rows = {
            name: [row._asdict() for row in getattr(self, name)]
            for name in ("tasks", "transfers", "links")
        }
        return asdict(self) | {"status": str(self.status)} | rows

    def to_pandas(self, table: str = "tasks") -> pd.DataFrame:
        """Return ``tasks``, ``transfers`` or ``links`` as a pandas DataFrame.

        Raises:
            ImportError: pandas is not installed.
            ValueError: There is no such table.
        """
        import pandas as pd

        if table not in ("tasks", "transfers", "links"):
            raise ValueError(f"no table {table!r}; there are tasks, transfers and links")
        return pd.DataFrame(getattr(self, table))


def prepare(
    scenario: Scenario | str | Path,
    *,
    limits: Limits | None = None,
    observers: Iterable[Watcher] = (),
    **overrides: object,
) -> Simulation:
    """Return a simulation of a scenario that can be stepped and observed.

    Args:
        scenario: A loaded scenario or the path of its file.
        limits: When to give up.
        observers: Who watches.
        **overrides: Values under ``config``, such as ``seed=7`` or ``scheduler="cpop"``; a
            mapping changes single keys of a section: ``rf={"tx_power_dBm": 18}``.

    Raises:
        ScenarioError: The scenario or an override is wrong; all faults are listed.
        PluginError: A component did not load.
    """
    assembly = assemble(overridden(scenario, overrides))
    return Simulation(assembly.network, assembly.models, limits, observers)


def simulate(
    scenario: Scenario | str | Path,
    *,
    limits: Limits | None = None,
    observers: Iterable[Watcher] = (),
    **overrides: object,
) -> RunResult:
    """Run a scenario to its end; arguments and errors as for ``prepare``."""
    chosen = overridden(scenario, overrides)
    simulation = prepare(chosen, limits=limits, observers=observers)
    with accompanied(simulation, chosen.name, chosen.config.seed):
        simulation.run()
    return result_of(simulation)


def overridden(scenario: Scenario | str | Path, overrides: Mapping[str, object]) -> Scenario:
    """Return a scenario with values under ``config`` replaced."""
    paths = dict(_dotted(overrides))
    if not isinstance(scenario, Scenario):
        return load_scenario(Path(scenario), overrides=paths)
    if not paths:
        return scenario
    return parse_scenario(scenario.to_document(), overrides=paths)


def _dotted(overrides: Mapping[str, object]) -> Iterable[tuple[str, object]]:
    for key, value in overrides.items():
        if isinstance(value, dict) and "type" not in value:
            yield from ((f"{key}.{inner}", each) for inner, each in value.items())
        else:
            yield key, value


def result_of(simulation: Simulation) -> RunResult:
    """Return the result of a simulation that has ended."""
    outcome = simulation.outcome
    if outcome is None:
        raise ValueError("the simulation has not ended; call run() first")
    state, network = simulation.state, simulation.setup.network
    return RunResult(
        status=outcome.status,
        makespan_s=outcome.makespan_s,
        detail=outcome.detail,
        ended_s=s_from_us(outcome.ended_us),
        events=outcome.events,
        tasks=tuple(_task_result(run, simulation) for run in state.tasks),
        transfers=tuple(_transfer_result(each, simulation) for each in state.transfers.values()),
        links=tuple(
            LinkResult(link.id, bandwidth_MBps, served_MB)
            for link, bandwidth_MBps, served_MB in zip(
                network.links, network.bandwidth_MBps, state.served_MB(), strict=True
            )
        ),
    )


def _task_result(run: TaskRun, simulation: Simulation) -> TaskResult:
    setup = simulation.setup
    return TaskResult(
        setup.injections[run.entry.dag].dag.id,
        run.entry.task.id,
        setup.network.nodes[run.node].id if run.node >= 0 else None,
        str(run.status),
        _seconds(run.ready_us),
        _seconds(run.started_us),
        _seconds(run.ended_us),
    )


def _transfer_result(transfer: Transfer, simulation: Simulation) -> TransferResult:
    setup, entry = simulation.setup, transfer.entry
    return TransferResult(
        setup.injections[entry.dag].dag.id,
        setup.tasks[entry.source].task.id,
        setup.tasks[entry.target].task.id,
        entry.size_MB,
        tuple(setup.network.links[index].id for index in transfer.route),
        s_from_us(transfer.created_us),
        _seconds(transfer.started_us),
        _seconds(transfer.ended_us),
        transfer.remaining_MB,
    )


def _seconds(instant: Instant | None) -> float | None:
    return None if instant is None else s_from_us(instant)
