"""Which waiting task is next?"""

from abc import ABC, abstractmethod
from dataclasses import dataclass

from ncsim_core.units import Instant
from ncsim_core.workflow import DagId, TaskId


@dataclass(frozen=True, slots=True)
class WaitingTask:
    """A task that is ready while its node is busy.

    Args:
        dag_id: DAG of the task.
        task_id: Id within the DAG.
        compute_cost: Compute units.
        ready_us: When its last input arrived.
        ticket: Number that tells it from every other task of the run; the engine's own.
    """

    dag_id: DagId
    task_id: TaskId
    compute_cost: float
    ready_us: Instant
    ticket: int


class QueueModel(ABC):
    """The waiting line of one node; the engine builds one per node and owns it.

    Nothing is lost and nothing invented: every task pushed is popped once.
    """

    @abstractmethod
    def push(self, task: WaitingTask) -> None:
        """Add a task that has just become ready."""

    @abstractmethod
    def pop(self) -> WaitingTask:
        """Remove and return the next task to run.

        Raises:
            IndexError: The queue is empty.
        """

    @abstractmethod
    def __len__(self) -> int:
        """Return how many tasks wait."""
