"""Queue models that break their contract."""

from typing import ClassVar

from ncsim_core.builtin.queue_models import FifoQueue

SHORT = 3


class NothingIsLostOrInvented(FifoQueue):
    def push(self, task):
        if len(self) < SHORT:
            super().push(task)


class DeclaredOrderIsKept(FifoQueue):
    def pop(self):
        return self._waiting.pop()


class PopOfNothingIsAnIndexError(FifoQueue):
    def pop(self):
        if not self._waiting:
            raise KeyError("empty")
        return super().pop()


class QueuesDoNotMeet(FifoQueue):
    everyones: ClassVar = []

    def __init__(self, context):
        super().__init__(context)
        self._waiting = self.everyones


class EqualRunsLeaveEqualTraces(FifoQueue):
    popped = 0

    def pop(self):
        EqualRunsLeaveEqualTraces.popped += 1
        waiting = self._waiting
        return waiting.pop() if self.popped % 3 else waiting.popleft()
