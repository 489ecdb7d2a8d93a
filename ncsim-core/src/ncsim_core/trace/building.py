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


class RunBuilder:
    """Collects what happens and makes tables of it.

    Args:
        preamble: Who ran what, on which nodes and links.
    """

    def __init__(self, preamble: TracePreamble) -> None:
        self.preamble = preamble
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
        self.steps: dict[int, list[RateStep]] = {}

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
        """Enter a transfer's new rate."""
        self.steps.setdefault(transfer, []).append(step)

    def build(self) -> RunTrace:
        """Return the tables as they are now."""
        preamble = self.preamble
        return RunTrace(
            header=preamble.header,
            level=preamble.level,
            plugins=preamble.plugins,
            nodes=preamble.nodes,
            links=preamble.links,
            dags=tuple(self.dags),
            tasks=self._tasks(),
            transfers=tuple(map(self._transfer, range(len(self.edges)))),
            end=self.end or RunEnd(TRUNCATED, self.now_us, None, 0),
        )

    def _tasks(self) -> tuple[RunTask, ...]:
        columns = (self.node_of_task, self.ready_us, self.started_us, self.ended_us)
        return tuple(
            RunTask(number, *name, *times)
            for number, (name, *times) in enumerate(zip(self.names, *columns, strict=True))
        )

    def _transfer(self, number: int) -> RunTransfer:
        dag, source, target, size_MB = self.edges[number]
        node = self.node_of_task[source]
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
            ended_us=self.transfer_ended_us[number],
            steps=tuple(self.steps.get(number, ())),
        )
