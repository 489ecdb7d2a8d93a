"""The tables of a run in the making, one column per list, so that every entry is cheap."""

from collections.abc import Sequence

from ncsim_core.trace.records import Injected, TracePreamble
from ncsim_core.trace.run_trace import (
    TRUNCATED,
    RateStep,
    RunDag,
    RunEnd,
    RunTask,
    RunTrace,
    RunTransfer,
)
from ncsim_core.units import MICROSECONDS_PER_SECOND


class RunBuilder:
    """Collects what happens and makes tables of it.

    Args:
        preamble: Who ran what, on which nodes and links.
        keeps_steps: Whether every rate is kept, or only what it amounts to, which takes
            memory that does not grow with the length of the run.
    """

    def __init__(self, preamble: TracePreamble, *, keeps_steps: bool = True) -> None:
        self.preamble = preamble
        self._keeps_steps = keeps_steps
        self.end: RunEnd | None = None
        self.now_us = 0
        self.dags: list[RunDag] = []
        self.names: list[tuple[int, str, float]] = []
        self.node_of_task: list[int | None] = []
        self.ready_us: list[int | None] = []
        self.started_us: list[int | None] = []
        self.ended_us: list[int | None] = []
        self.edges: list[tuple[int, int, int, float]] = []
        self.route: list[tuple[int, ...]] = []
        self.transfer_started_us: list[int | None] = []
        self.transfer_ended_us: list[int | None] = []
        self._steps: dict[int, list[RateStep]] = {}
        self._service: dict[int, tuple[float, float, int]] = {}

    def inject(self, record: Injected) -> None:
        """Enter a DAG and number its tasks and edges.

        Raises:
            ValueError: The record's numbers do not continue what was entered before, or one
                of its edges ends at a task of another DAG.
        """
        first_task, first_edge = len(self.names), len(self.edges)
        if (record.dag, record.first_task, record.first_edge) != (
            len(self.dags),
            first_task,
            first_edge,
        ):
            raise ValueError(
                f"inject: DAG, first task and first edge must be numbered {len(self.dags)}, "
                f"{first_task} and {first_edge}"
            )
        self.names += [(record.dag, task_id, cost) for task_id, cost in record.tasks]
        for source, target, size_MB in record.edges:
            if not (first_task <= source < len(self.names) > target >= first_task):
                raise ValueError(f"inject: edge {source} -> {target} leaves its DAG")
            self.edges.append((record.dag, source, target, size_MB))
        for column in (self.node_of_task, self.ready_us, self.started_us, self.ended_us):
            column.extend([None] * len(record.tasks))
        for times in (self.transfer_started_us, self.transfer_ended_us):
            times.extend([None] * len(record.edges))
        self.route += [()] * len(record.edges)
        self.dags.append(
            RunDag(
                record.dag,
                record.dag_id,
                record.at_us,
                first_task,
                len(record.tasks),
                first_edge,
                len(record.edges),
            )
        )

    def place(self, dag: int, nodes: Sequence[int]) -> None:
        """Enter the node of each task of a DAG.

        Raises:
            ValueError: There are more or fewer nodes than tasks.
        """
        entry = self.dags[dag]
        if len(nodes) != entry.task_count:
            raise ValueError(f"place: {len(nodes)} nodes for {entry.task_count} tasks")
        first = entry.first_task
        self.node_of_task[first : first + entry.task_count] = nodes

    def add_step(self, transfer: int, step: RateStep) -> None:
        """Enter a transfer's new rate and what explains it."""
        if self._keeps_steps:
            self._steps.setdefault(transfer, []).append(step)
        self.set_rate(transfer, step.at_us, step.rate_MBps)

    def set_rate(self, transfer: int, at_us: int, rate_MBps: float) -> None:
        """Enter a transfer's new rate, and credit what it was served at the old one."""
        self._service[transfer] = (self._credited_MB(transfer, at_us), rate_MBps, at_us)

    def end_transfer(self, transfer: int, at_us: int) -> None:
        """Enter that a transfer has been served."""
        self.transfer_ended_us[transfer] = at_us
        self._service.pop(transfer, None)

    def _credited_MB(self, transfer: int, at_us: int) -> float:
        """Return what an unfinished transfer has been served by an instant."""
        served_MB, rate_MBps, since_us = self._service.get(transfer, (0.0, 0.0, at_us))
        return served_MB + rate_MBps * (at_us - since_us) / MICROSECONDS_PER_SECOND

    def build(self) -> RunTrace:
        """Return the tables as they are now."""
        preamble = self.preamble
        end = self.end or RunEnd(TRUNCATED, self.now_us, None, 0)
        return RunTrace(
            header=preamble.header,
            level=preamble.level if self._keeps_steps else "coarse",
            plugins=preamble.plugins,
            nodes=preamble.nodes,
            links=preamble.links,
            dags=tuple(self.dags),
            tasks=self._tasks(),
            transfers=tuple(self._transfer(number, end) for number in range(len(self.edges))),
            end=end,
        )

    def _tasks(self) -> tuple[RunTask, ...]:
        columns = (self.node_of_task, self.ready_us, self.started_us, self.ended_us)
        return tuple(
            RunTask(number, *name, *times)
            for number, (name, *times) in enumerate(zip(self.names, *columns, strict=True))
        )

    def _transfer(self, number: int, end: RunEnd) -> RunTransfer:
        dag, source, target, size_MB = self.edges[number]
        node, ended_us = self.node_of_task[source], self.transfer_ended_us[number]
        served_MB = min(size_MB, self._credited_MB(number, end.ended_us))
        return RunTransfer(
            number=number,
            dag=dag,
            source=source,
            target=target,
            size_MB=size_MB,
            is_local=node is not None and node == self.node_of_task[target],
            created_us=self.ended_us[source],
            route=self.route[number],
            started_us=self.transfer_started_us[number],
            ended_us=ended_us,
            served_MB=served_MB if ended_us is None else size_MB,
            steps=tuple(self._steps.get(number, ())),
        )
