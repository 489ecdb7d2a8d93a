"""A child process with ``PYTHONHASHSEED=0`` that makes plans, and how to ask it.

BIL, MSBC and ETF walk sets of plain strings, whose order only the hash seed of the whole process
decides (SPEC 22). The child starts with the first such plan, then serves this process for the
rest of its life: SAGA is imported once. SMT's solver is not the same after a plan, so each of
its plans gets a child of its own. Requests and answers are single lines of JSON.
"""

import atexit
import json
import os
import subprocess
import sys
import tempfile
import threading
from typing import IO, TYPE_CHECKING

from ncsim_core.errors import NcsimError, PlacementError

from ncsim_saga.catalogue import SCHEDULERS

if TYPE_CHECKING:
    from ncsim_core.workflow import TaskId

    from ncsim_saga.planning import PlanRequest

LINES_OF_A_CRASH = 5


class Worker:
    """The running child; it ends when its standard input does."""

    def __init__(self) -> None:
        self.owner = os.getpid()
        self._complaints: IO[str] = tempfile.TemporaryFile(  # noqa: SIM115  # close() does
            "w+", encoding="utf-8"
        )
        self._process = subprocess.Popen(
            [sys.executable, "-m", "ncsim_saga.worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._complaints,
            text=True,
            encoding="utf-8",
            env={
                **os.environ,
                "PYTHONHASHSEED": "0",
                "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
            },
        )

    def ask(self, line: str) -> str:
        """Return the answer to one line.

        Raises:
            PlacementError: The child is gone; what it said last is in the message.
        """
        requests, answers = self._process.stdin, self._process.stdout
        if requests is None or answers is None:
            raise PlacementError("SAGA's child process has no pipes")
        try:
            requests.write(line + "\n")
            requests.flush()
            answer = answers.readline()
        except OSError:
            answer = ""
        if not answer:
            raise PlacementError(self._obituary())
        return answer

    def close(self) -> None:
        """End the child and wait for it."""
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                pipe.close()
        self._process.wait()
        self._complaints.close()

    def _obituary(self) -> str:
        code = self._process.wait()
        self._complaints.seek(0)
        last_words = self._complaints.read().strip().splitlines()[-LINES_OF_A_CRASH:]
        return "\n  ".join(
            [f"SAGA's child process ended with code {code} in the middle of a plan", *last_words]
        )


_lock = threading.Lock()
_worker: Worker | None = None


def plan_in_child(request: "PlanRequest") -> "dict[TaskId, int]":
    """Return the node index of every task, by SAGA, in a process with hash seed 0.

    Raises:
        PlacementError: SAGA gave up, left tasks out, or the child ended.
    """
    is_alone = SCHEDULERS[request.scheduler].keeps_state
    with _lock:
        if is_alone:
            stop()
        try:
            answer = json.loads(_running_worker().ask(request.to_json()))
        except PlacementError:
            stop()
            raise
        if is_alone:
            stop()
    if "error" in answer:
        raise PlacementError(answer["error"])
    return dict(answer["placement"])


def stop() -> None:
    """End the child process, if there is one; the next plan starts another."""
    global _worker  # noqa: PLW0603  # one child per process is the point
    if _worker is not None and _worker.owner == os.getpid():
        _worker.close()
    _worker = None


def _running_worker() -> Worker:
    """Return this process's own child; one inherited through a fork belongs to the parent."""
    global _worker  # noqa: PLW0603
    if _worker is None or _worker.owner != os.getpid():
        _worker = Worker()
        atexit.register(stop)
    return _worker


def serve(requests: IO[str], answers: IO[str]) -> None:
    """Answer requests, one line each, until there are no more."""
    from ncsim_saga.planning import PlanRequest, plan_with_saga

    for line in requests:
        answer: dict[str, object]
        try:
            answer = {"placement": plan_with_saga(PlanRequest.from_json(line))}
        except NcsimError as error:
            answer = {"error": str(error)}
        answers.write(json.dumps(answer) + "\n")
        answers.flush()


def main() -> None:
    """Serve standard input; whatever SAGA prints goes to standard error."""
    answers, sys.stdout = sys.stdout, sys.stderr
    serve(sys.stdin, answers)


if __name__ == "__main__":
    main()
