"""Keeps an executor busy with chunks of runs, and finds the run that breaks it.

When workers die, every run that was in flight is a suspect. Suspects are done again one at a
time. One whose worker dies three times while nothing else is in flight, or that used up its wall
limit, is to blame: it becomes a failed row and the sweep goes on. Three times, since a worker may
also be killed from outside.
"""

import time
from collections import Counter, deque
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from itertools import islice
from typing import Final

from ncsim_core.errors import NcsimError
from ncsim_core.sweep.executors import ExecutorFactory, ExecutorRequest, parallelism
from ncsim_core.sweep.plan import SweepPlan
from ncsim_core.sweep.worker import Item, ResultRow, failed_row, ready, run_chunk

CHUNK_s: Final = 0.5
"""How long a chunk should take: what is lost at most when everything is killed."""
FIRST_CHUNK: Final = 4
MAX_CHUNK: Final = 256
CHUNKS_PER_WORKER: Final = 2
START_s: Final = 120.0
LOOK_EVERY_s: Final = 5.0
STRIKES: Final = 3
"""Workers that a run may take with it."""


class Dispatcher:
    """Does the runs of one plan.

    Args:
        plan: The sweep.
        factory: Makes the executor, and another one when it breaks.
        request: What the user asks of the executor.
    """

    def __init__(self, plan: SweepPlan, factory: ExecutorFactory, request: ExecutorRequest) -> None:
        self._limits = plan.limits
        self._text = plan.to_json()
        self._new_executor: Callable[[], Executor] = lambda: factory(request)
        self._request = request
        self._executor = self._new_executor()
        self._window = CHUNKS_PER_WORKER * parallelism(self._executor, request)
        self._chunk = FIRST_CHUNK
        self._in_flight: dict[Future[list[ResultRow]], list[Item]] = {}
        self._suspects: deque[Item] = deque()
        self._strikes: Counter[str] = Counter()
        self._submitted_s = 0.0

    def results(self, items: Iterator[Item]) -> Iterator[list[ResultRow]]:
        """Yield the results of all items, chunk by chunk, in the order in which they come.

        Raises:
            NcsimError: Workers do not start, or none is left.
        """
        try:
            while self._fill(items) or self._suspects:
                done, _ = wait(self._in_flight, LOOK_EVERY_s, FIRST_COMPLETED)
                if not done:
                    self._look_after_executor()
                for future in [each for each in self._in_flight if each in done]:
                    if future in self._in_flight:
                        yield from self._collected(future)
        finally:
            self._executor.shutdown(wait=False, cancel_futures=True)

    def _look_after_executor(self) -> None:
        """Ask an executor that can tell whether anybody is left to work."""
        ask: Callable[[], str | None] = getattr(self._executor, "trouble", lambda: None)
        trouble = ask()
        if trouble is not None:
            raise NcsimError(f"{trouble}; what is done is kept, run the same command again")

    def _fill(self, items: Iterator[Item]) -> bool:
        """Submit until enough is in flight; return whether anything is."""
        if self._suspects:
            if not self._in_flight:
                self._submit([self._suspects.popleft()])
            return True
        while len(self._in_flight) < self._window:
            chunk = list(islice(items, self._chunk))
            if not chunk:
                break
            self._submit(chunk)
            if self._suspects:
                break
        return bool(self._in_flight)

    def _submit(self, chunk: list[Item]) -> None:
        try:
            future = self._executor.submit(run_chunk, self._text, chunk)
        except BrokenExecutor:
            self._suspects.extend(chunk)
            self._replace_executor()
        else:
            self._in_flight[future] = chunk
            self._submitted_s = time.monotonic()

    def _collected(self, future: "Future[list[ResultRow]]") -> Iterator[list[ResultRow]]:
        chunk = self._in_flight.pop(future)
        try:
            rows = future.result()
        except Exception as error:  # whatever an executor may throw
            yield from self._accused(chunk, error)
            return
        self._adapt(rows)
        yield rows

    def _accused(self, chunk: list[Item], error: Exception) -> Iterator[list[ResultRow]]:
        was_alone = len(chunk) == 1 and not self._in_flight
        if was_alone and self._is_guilty(chunk[0], error):
            yield [self._blamed(chunk[0], error)]
        else:
            self._suspects.extend(chunk)
        if isinstance(error, BrokenExecutor):
            finished = [each for each in self._in_flight if each.done() and not each.exception()]
            for future in finished:
                self._in_flight.pop(future)
                yield future.result()
            self._replace_executor()

    def _is_guilty(self, item: Item, error: Exception) -> bool:
        """Count one more death of a run that was alone; return whether it is to blame for it."""
        self._strikes[item.key] += 1
        wall_s = self._limits.wall_s
        has_hung = wall_s is not None and time.monotonic() - self._submitted_s >= wall_s
        was_tried_again = not isinstance(error, BrokenExecutor)  # clusters do so by themselves
        return has_hung or was_tried_again or self._strikes[item.key] >= STRIKES

    def _blamed(self, item: Item, error: Exception) -> ResultRow:
        wall_s = self._limits.wall_s
        what = f"{type(error).__name__}: {error}"
        if wall_s is None:
            return failed_row(item.key, f"its worker died ({what})")
        text = f"its worker died, or gave no answer within the wall limit of {wall_s:g} s ({what})"
        return failed_row(item.key, text)

    def _replace_executor(self) -> None:
        """Start anew, once it is certain that workers can start at all.

        Whatever was in flight is a suspect.
        """
        for left in self._in_flight.values():
            self._suspects.extend(left)
        self._in_flight.clear()
        self._executor.shutdown(wait=False, cancel_futures=True)
        self._executor = self._new_executor()
        try:
            self._executor.submit(ready).result(timeout=START_s)
        except (BrokenExecutor, TimeoutError) as error:
            raise NcsimError(f"workers do not start: {type(error).__name__}: {error}") from error

    def _adapt(self, rows: list[ResultRow]) -> None:
        """Choose the chunk size by how long runs take."""
        mean_s = sum(row.wall_s for row in rows) / max(1, len(rows))
        wanted = int(CHUNK_s / mean_s) if mean_s > 0 else MAX_CHUNK
        self._chunk = max(1, min(MAX_CHUNK, wanted, 2 * self._chunk))
