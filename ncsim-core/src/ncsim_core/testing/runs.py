"""Whole runs with one component under test and the plainest ones beside it."""

import io
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, NamedTuple, cast

from ncsim_core.contracts.link_model import LinkModel
from ncsim_core.engine.outcome import Outcome
from ncsim_core.engine.setup import Reach
from ncsim_core.engine.simulation import Simulation
from ncsim_core.models import Models
from ncsim_core.network import Network
from ncsim_core.testing import toys
from ncsim_core.testing.questions import Case
from ncsim_core.testing.subject import Subject
from ncsim_core.trace.check import check_trace
from ncsim_core.trace.records import TraceLevel
from ncsim_core.trace.writer import TraceWriter
from ncsim_core.units import us_from_s
from ncsim_core.workflow import DAG, TaskId

FIELD_BY_KIND: Final = {
    "scheduler": "scheduler",
    "routing_model": "routing",
    "link_model": "link_model",
    "interference_model": "interference",
    "queue_model": "new_queue",
    "dag_source": "dag_source",
}


class Traced(NamedTuple):
    """A run that has ended, and its trace."""

    outcome: Outcome
    trace: str


def run_with(
    subject: Subject, case: Case, reach: Reach = Reach.LOCAL, level: TraceLevel = "full"
) -> Traced:
    """Return a run of the case's injections with the component built anew."""
    network, models = _who_decides(subject, case)
    trace = io.StringIO()
    simulation = Simulation(
        network, models, observers=[TraceWriter(trace, level=level)], reach=reach
    )
    return Traced(simulation.run(), trace.getvalue())


def _who_decides(subject: Subject, case: Case) -> tuple[Network, Models]:
    component: object = subject.build(case)
    network = case.network
    if subject.component.kind == "link_model":
        network = network.with_rates(cast("LinkModel", component).rate_links(network))
    if subject.component.kind == "queue_model":
        component = lambda: subject.build(case)  # noqa: E731 - one queue per node
    kind = subject.component.kind
    chosen: dict[str, Any] = {
        FIELD_BY_KIND[kind]: component,
        "identities": {kind: subject.identity},
    }
    return network, replace(toys.models(network, case.injections), **chosen)


def trace_faults(trace: str) -> list[str]:
    """Return what in a trace cannot be."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "trace.jsonl"
        path.write_text(trace, "utf-8")
        return [f"line {each.line}: {each.message}" for each in check_trace(path)]


def least_makespan_us(case: Case) -> int:
    """Return a bound no run can beat: critical paths on the fastest node, transfers free."""
    fastest = max(node.compute_capacity for node in case.network.nodes)
    ends = [each.at_us + _critical_path_us(each.dag, fastest) for each in case.injections]
    return max(ends, default=0)


def _critical_path_us(dag: DAG, capacity: float) -> int:
    """Return the longest chain of rounded durations at one capacity."""
    left = {task.id: len(dag.incoming[task.id]) for task in dag.tasks}
    duration_us = {task.id: us_from_s(task.compute_cost / capacity) for task in dag.tasks}
    end_us: dict[TaskId, int] = dict(duration_us)
    free = [task_id for task_id, count in left.items() if count == 0]
    for task_id in free:
        for dependency in dag.outgoing[task_id]:
            target = dependency.target
            end_us[target] = max(end_us[target], end_us[task_id] + duration_us[target])
            left[target] -= 1
            if left[target] == 0:
                free.append(target)
    return max(end_us.values(), default=0)
