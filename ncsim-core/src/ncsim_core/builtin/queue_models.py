"""The waiting line that serves first who came first."""

from collections import deque

from typing_extensions import override

from ncsim_core.context import BuildContext
from ncsim_core.contracts.queue_model import QueueModel, WaitingTask


class FifoQueue(QueueModel):
    """First in, first out."""

    def __init__(self, context: BuildContext) -> None:
        del context
        self._waiting: deque[WaitingTask] = deque()

    @override
    def push(self, task: WaitingTask) -> None:
        self._waiting.append(task)

    @override
    def pop(self) -> WaitingTask:
        return self._waiting.popleft()

    @override
    def __len__(self) -> int:
        return len(self._waiting)
