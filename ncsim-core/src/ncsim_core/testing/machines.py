"""A waiting line pushed and popped at random, compared with the plainest one there is."""

from collections.abc import Callable

from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from ncsim_core.contracts.queue_model import QueueModel, WaitingTask
from ncsim_core.testing.drawing import COSTS
from ncsim_core.testing.strategies import waiting_task

ORDER_KEYS: dict[str, Callable[[WaitingTask], tuple[float, ...]]] = {
    "fifo": lambda task: (task.ticket,),
    "lifo": lambda task: (-task.ticket,),
    "shortest": lambda task: (task.compute_cost, task.ticket),
    "longest": lambda task: (-task.compute_cost, task.ticket),
}
"""What ``order=<name>`` promises: the waiting task with the least key is popped."""


def queue_machine(
    new_queue: Callable[[], QueueModel], order: str | None
) -> type[RuleBasedStateMachine]:
    """Return a state machine over queues that ``new_queue`` makes.

    Args:
        new_queue: Makes an empty queue.
        order: A name in ``ORDER_KEYS``, or ``None`` if any waiting task may be popped.
    """

    class QueueMachine(RuleBasedStateMachine):
        """Nothing is lost, nothing invented, and the declared order is kept."""

        def __init__(self) -> None:
            super().__init__()
            self.queue = new_queue()
            self.waiting: dict[int, WaitingTask] = {}
            self.pushed = 0

        @rule(cost=st.sampled_from(COSTS))
        def push(self, cost: float) -> None:
            """Push a task that the queue has not seen."""
            task = waiting_task(self.pushed, cost, ready_us=self.pushed)
            self.pushed += 1
            self.waiting[task.ticket] = task
            self.queue.push(task)

        @precondition(lambda self: self.waiting)
        @rule()
        def pop(self) -> None:
            """Pop a task that waits, the right one if an order is declared."""
            task = self.queue.pop()
            assert self.waiting.get(task.ticket) == task, f"{task} is not waiting"
            if order is not None:
                first = min(self.waiting.values(), key=ORDER_KEYS[order])
                assert task == first, f"{task} came before {first}, against order={order}"
            del self.waiting[task.ticket]

        @invariant()
        def length_is_told(self) -> None:
            """``len()`` is the number of waiting tasks."""
            assert len(self.queue) == len(self.waiting), f"len() is {len(self.queue)}"

    return QueueMachine
