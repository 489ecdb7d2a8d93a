"""An engine that is slow, exact and written apart: what the real one is compared with.

It follows Section V of the paper and shares nothing with ``ncsim_core.engine`` but the models it
asks. Amounts are fractions, so nothing is lost. There is no heap and no refresh: after every
event each rate is worked out anew from all transfers under way, each completion follows from
what is left, and the next event is the least of a list.
"""

import math
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import Final, NamedTuple, TypeAlias

from ncsim_core.contracts.queue_model import WaitingTask
from ncsim_core.contracts.routing_model import RouteTable
from ncsim_core.contracts.scheduler import ActiveTransfer, NetworkSnapshot
from ncsim_core.models import Models
from ncsim_core.network import Network, Route
from ncsim_core.workflow import DAG, DagId, Dependency, Injection, Task, TaskId

MILLION: Final = 1_000_000
SLACK_us: Final = Fraction(1, 100_000)
"""An end this little after a whole microsecond belongs to it."""

TOO_CLOSE_us: Final = Fraction(1, 1_000_000)
"""Nearer than this to the edge of rounding, floating point may honestly fall on either side."""

TransferKey: TypeAlias = tuple[str, str, str]
INJECT, TASK_ENDS, TRANSFER_ENDS, READY, TASK_STARTS, TRANSFER_STARTS = range(6)


class Pending(NamedTuple):
    """Something that is going to happen; ``tie`` decides at one time and priority."""

    at_us: int
    priority: int
    tie: tuple[int, ...] | TransferKey
    action: Callable[[], None]


class Job:
    """A task of the run and what has become of it."""

    def __init__(self, number: int, dag: DAG, task: Task, missing: int) -> None:
        self.number, self.dag, self.task, self.missing = number, dag, task, missing
        self.node = -1
        self.ready_us: int | None = None
        self.started_us: int | None = None
        self.ended_us: int | None = None


class Flow:
    """A transfer of the run and what has become of it."""

    def __init__(self, dependency: Dependency, ends: tuple[Job, Job], route: Route) -> None:
        self.ends, self.route = ends, route
        self.key: TransferKey = (ends[0].dag.id, dependency.source, dependency.target)
        self.size_MB = self.left_MB = Fraction(dependency.data_size_MB)
        self.created_us = 0
        self.started_us: int | None = None
        self.ended_us: int | None = None


class ReferenceEngine:
    """One run from beginning to end.

    Args:
        network: Nodes and links, rates decided.
        models: The six components; only their plain forms are asked.
        max_events: Events to handle at most.
        max_time_us: Simulated time that no event may pass.

    ``is_too_close`` tells that rounding hung by a hair somewhere, so that a comparison with
    floating point means nothing.
    """

    def __init__(
        self,
        network: Network,
        models: Models,
        max_events: int | None = None,
        max_time_us: int | None = None,
    ) -> None:
        self.network, self.models = network, models
        self.max_events, self.max_time_us = max_events, max_time_us
        self.routes = RouteTable(models.routing, network)
        self.status: str | None = None
        self.makespan_us: int | None = None
        self.now_us = self.events = self.free_tasks_placed = self._ticket = 0
        self.is_too_close = False
        self.jobs: list[Job] = []
        self.flows: list[Flow] = []
        self.served_MB = [Fraction(0)] * len(network.links)
        self.lines = [models.new_queue() for _ in network.nodes]
        self.claims: list[Job | None] = [None] * len(network.nodes)
        self.pending: list[Pending] = []
        self._job_of: dict[tuple[str, str], Job] = {}
        self._rates: dict[Flow, Fraction] = {}
        for injection in models.dag_source.injections():
            self._expect(injection)

    def _expect(self, injection: Injection) -> None:
        dag = injection.dag
        for task in dag.tasks:
            job = Job(len(self.jobs), dag, task, len(dag.incoming[task.id]))
            self.jobs.append(job)
            self._job_of[dag.id, task.id] = job
        self._later(injection.at_us, INJECT, lambda: self.inject(dag))

    def _later(
        self,
        at_us: int,
        priority: int,
        action: Callable[[], None],
        key: TransferKey | None = None,
    ) -> None:
        self._ticket += 1
        self.pending.append(Pending(at_us, priority, key or (self._ticket,), action))

    def run(self) -> "ReferenceEngine":
        """Run to the end."""
        while self.status is None:
            self.step()
        return self

    def step(self) -> None:
        """Handle the next event, or find that there is none."""
        upcoming = [*self.pending, *self.completions()]
        due = min(upcoming, key=lambda each: each[:3], default=None)
        if due is None:
            self._stop_with_nothing_left()
        elif self._is_beyond_limits(due):
            self.status = "limit_reached"
        else:
            self.pending = [each for each in self.pending if each is not due]
            self.serve_until(due.at_us)
            self.events += 1
            due.action()

    def _is_beyond_limits(self, due: Pending) -> bool:
        is_late = self.max_time_us is not None and due.at_us > self.max_time_us
        return is_late or self.events == self.max_events

    def _stop_with_nothing_left(self) -> None:
        ends = [job.ended_us for job in self.jobs]
        if None in ends:
            self.status = "blocked_wireless"
        else:
            self.status, self.makespan_us = "completed", max((e for e in ends if e), default=0)

    # Service

    def active_flows(self) -> list[Flow]:
        """Return the transfers that have begun and not ended, zero-byte ones left out."""
        return [
            f for f in self.flows if f.started_us is not None and f.ended_us is None and f.size_MB
        ]

    def rates(self) -> dict[Flow, Fraction]:
        """Return the rate of every active transfer: the least share on its route (Eq. 1)."""
        flows = self.active_flows()
        if self.models.interference.decides_routes:
            return self.route_rates(sorted(flows, key=lambda flow: flow.route))
        counts: dict[int, int] = {}
        for link in (link for flow in flows for link in flow.route):
            counts[link] = counts.get(link, 0) + 1
        active = sorted(counts)
        factors = self.models.interference.factors(active, active) if active else ()
        bandwidth_MBps = self.network.bandwidth_MBps
        share = {
            link: Fraction(bandwidth_MBps[link]) * Fraction(float(factor)) / counts[link]
            for link, factor in zip(active, factors, strict=True)
        }
        return {flow: min(share[link] for link in flow.route) for flow in flows}

    def route_rates(self, flows: list[Flow]) -> dict[Flow, Fraction]:
        """Return what a model that decides the rates of whole routes gives to each transfer."""
        if not flows:
            return {}
        answer = self.models.interference.route_rates([flow.route for flow in flows])
        rates = [Fraction(float(rate_MBps)) for rate_MBps in answer.rates_MBps]
        return dict(zip(flows, rates, strict=True))

    def serve_until(self, at_us: int) -> None:
        """Move the clock; every transfer is served at its rate meanwhile (Eq. 13)."""
        for flow, rate_MBps in self._rates.items():
            due_MB = rate_MBps * (at_us - self.now_us) / MILLION
            self.serve(flow, min(flow.left_MB, due_MB))
        self.now_us = at_us

    def serve(self, flow: Flow, served_MB: Fraction) -> None:
        """Count bytes as arrived, on every link of the route."""
        flow.left_MB -= served_MB
        for link in flow.route:
            self.served_MB[link] += served_MB

    def completions(self) -> list[Pending]:
        """Return when each active transfer would end if no rate moved any more."""
        found = []
        for flow, rate_MBps in self._rates.items():
            if flow.left_MB == 0:
                after_us = 0
            elif rate_MBps > 0:
                after_us = self.rounded_up(flow.left_MB / rate_MBps * MILLION)
            else:
                continue
            at_us = self.now_us + after_us
            found.append(Pending(at_us, TRANSFER_ENDS, flow.key, partial(self.finish, flow)))
        return found

    def rounded_up(self, exact_us: Fraction) -> int:
        """Return the whole microsecond by which a service time is over."""
        edge_us = exact_us - SLACK_us
        self.is_too_close |= abs(edge_us - round(edge_us)) < TOO_CLOSE_us
        return max(0, math.ceil(edge_us))

    def rounded(self, exact_us: Fraction) -> int:
        """Return the nearest whole microsecond."""
        half_us = exact_us - Fraction(1, 2)
        self.is_too_close |= abs(half_us - round(half_us)) < TOO_CLOSE_us
        return round(exact_us)

    # What happens

    def inject(self, dag: DAG) -> None:
        """Place a DAG; end the run if one of its dependencies has no way to go."""
        plan = self.models.scheduler.schedule(dag, self.snapshot())
        for task in dag.tasks:
            job = self._job_of[dag.id, task.id]
            job.node = self.network.node_index[task.pinned_to or plan.nodes[task.id]]
            self.free_tasks_placed += task.pinned_to is None
        if any(self._has_no_way(dag, each) for each in dag.dependencies):
            self.status = "unroutable"
            return
        for task in dag.tasks:
            if not dag.incoming[task.id]:
                self.announce(self._job_of[dag.id, task.id])

    def _has_no_way(self, dag: DAG, dependency: Dependency) -> bool:
        source = self._job_of[dag.id, dependency.source].node
        target = self._job_of[dag.id, dependency.target].node
        return source != target and self.routes.route(source, target) is None

    def snapshot(self) -> NetworkSnapshot:
        """Return what a scheduler may see."""
        waiting = [
            len(line) + (claim is not None)
            for line, claim in zip(self.lines, self.claims, strict=True)
        ]
        under_way = [f for f in self.flows if f.started_us is not None and f.ended_us is None]
        active = [
            ActiveTransfer(
                DagId(flow.key[0]),
                TaskId(flow.key[1]),
                TaskId(flow.key[2]),
                flow.ends[0].node,
                flow.ends[1].node,
                float(flow.left_MB),
            )
            for flow in under_way
        ]
        return NetworkSnapshot(
            self.network,
            self.routes,
            self.now_us / MILLION,
            tuple(waiting),
            tuple(active),
            self.free_tasks_placed,
        )

    def announce(self, job: Job) -> None:
        """Say that a task has all it needs."""
        self._later(self.now_us, READY, lambda: self.become_ready(job))

    def become_ready(self, job: Job) -> None:
        """Claim the node, or wait in its line."""
        job.ready_us = self.now_us
        if self.claims[job.node] is None:
            self.claim(job)
        else:
            waiting = WaitingTask(
                job.dag.id, job.task.id, job.task.compute_cost, self.now_us, job.number
            )
            self.lines[job.node].push(waiting)

    def claim(self, job: Job) -> None:
        """Reserve the node now; the task starts later in the same instant."""
        self.claims[job.node] = job
        self._later(self.now_us, TASK_STARTS, lambda: self.start_task(job))

    def start_task(self, job: Job) -> None:
        """Run a task on its node."""
        job.started_us = self.now_us
        capacity = Fraction(self.network.nodes[job.node].compute_capacity)
        duration_us = self.rounded(Fraction(job.task.compute_cost) / capacity * MILLION)
        self._later(self.now_us + duration_us, TASK_ENDS, lambda: self.end_task(job))

    def end_task(self, job: Job) -> None:
        """Free the node for the head of its line, then send the results."""
        job.ended_us = self.now_us
        self.hand_over(job.node)
        for dependency in job.dag.outgoing[job.task.id]:
            target = self._job_of[job.dag.id, dependency.target]
            if target.node == job.node:
                self.deliver(target)
            else:
                self.create(dependency, job, target)

    def hand_over(self, node: int) -> None:
        """Give a free node to the task that its line names."""
        self.claims[node] = None
        if len(self.lines[node]):
            self.claim(self.jobs[self.lines[node].pop().ticket])

    def create(self, dependency: Dependency, source: Job, target: Job) -> None:
        """Choose a route and pay its latency; no link is used meanwhile."""
        route = self.routes.route(source.node, target.node) or ()
        flow = Flow(dependency, (source, target), route)
        flow.created_us = self.now_us
        self.flows.append(flow)
        latency_s = sum((Fraction(self.network.latency_s[link]) for link in route), Fraction(0))
        at_us = self.now_us + self.rounded(latency_s * MILLION)
        self._later(at_us, TRANSFER_STARTS, lambda: self.start(flow), flow.key)

    def start(self, flow: Flow) -> None:
        """Begin byte service; without bytes it is over at once, whatever the rate."""
        flow.started_us = self.now_us
        if flow.size_MB == 0:
            self._later(self.now_us, TRANSFER_ENDS, lambda: self.finish(flow), flow.key)
        self._rates = self.rates()

    def finish(self, flow: Flow) -> None:
        """Free the route and hand over the data; what rounding held back is served with it."""
        self.serve(flow, flow.left_MB)
        flow.ended_us = self.now_us
        self._rates = self.rates()
        self.deliver(flow.ends[1])

    def deliver(self, target: Job) -> None:
        """Count an input as arrived."""
        target.missing -= 1
        if target.missing == 0:
            self.announce(target)
