"""Runs that the page asked for: one after the other, each in a process with limits."""

import re
import shutil
import tempfile
import threading
import time
from collections import deque
from dataclasses import asdict, dataclass, field
from http import HTTPStatus
from pathlib import Path
from typing import Final, Literal, TypeAlias

from ncsim_core.cli.exit_codes import ExitCode

from ncsim_viz.server.child import Limits
from ncsim_viz.server.entries import Entries
from ncsim_viz.server.errors import RequestError, conflict, missing
from ncsim_viz.server.library import Library
from ncsim_viz.server.processes import LimitedProcess
from ncsim_viz.server.progress import Progress

MAX_WAITING: Final = 50
MAX_KEPT: Final = 200
LOOK_EVERY_s: Final = 0.1
ENTRY: Final = "ncsim_core.cli.main:main"

State: TypeAlias = Literal["queued", "running", "ended", "failed", "cancelled"]

_UNWANTED = re.compile(r"[^A-Za-z0-9._-]+")


@dataclass
class Job:
    """A run that the page asked for.

    Args:
        id: Number as text.
        name: As asked for.
        run: Id that its entry has or will have.
        yaml: The scenario.
        tasks: How many tasks it asks for.
        state: How far it is.
        status: How the run ended.
        message: Why it failed.
        queued_s: When it was asked for, on a clock that only counts.
        started_s: When it was begun.
        ended_s: When it ended.
        progress: What its trace says so far.
        is_unwanted: Whether it was cancelled.
    """

    id: str
    name: str
    run: str
    yaml: str
    tasks: int
    state: State = "queued"
    status: str | None = None
    message: str = ""
    queued_s: float = field(default_factory=time.monotonic)
    started_s: float | None = None
    ended_s: float | None = None
    progress: Progress | None = None
    is_unwanted: bool = False

    def to_json(self) -> dict[str, object]:
        """Return the job ready for JSON."""
        now_s = time.monotonic()
        started_s, ended_s = self.started_s or self.ended_s or now_s, self.ended_s or now_s
        return {
            "id": self.id,
            "name": self.name,
            "run": self.run,
            "state": self.state,
            "status": self.status,
            "message": self.message,
            "progress": None if self.progress is None else self.progress.to_json(self.tasks),
            "waited_s": started_s - self.queued_s,
            "ran_s": None if self.started_s is None else ended_s - self.started_s,
        }


class Jobs:
    """The queue and the thread that works it off.

    Args:
        library: Where the runs go.
        entries: Tells how a run ended.
        limits: What each run may take.
    """

    def __init__(self, library: Library, entries: Entries, limits: Limits) -> None:
        self._library = library
        self._entries = entries
        self.limits = limits
        self._jobs: dict[str, Job] = {}
        self._waiting: deque[Job] = deque()
        self._changed = threading.Condition()
        self._is_closing = False
        self._count = 0
        self._thread = threading.Thread(target=self._work, name="ncsim jobs", daemon=True)
        self._thread.start()

    def document(self) -> dict[str, object]:
        """Return all jobs, oldest first, and the limits."""
        with self._changed:
            jobs = [job.to_json() for job in self._jobs.values()]
        return {"jobs": jobs, "limits": {**asdict(self.limits), "waiting": MAX_WAITING}}

    def add(self, yaml: str, name: str, tasks: int) -> dict[str, object]:
        """Queue a run and return it, ready for JSON.

        Raises:
            RequestError: Too many wait already.
        """
        with self._changed:
            if len(self._waiting) >= MAX_WAITING:
                message = f"{MAX_WAITING} runs wait already; let some end, or cancel them"
                raise RequestError(HTTPStatus.TOO_MANY_REQUESTS, message)
            self._count += 1
            job = Job(str(self._count), name, self._free_id(name), yaml, tasks)
            self._jobs[job.id] = job
            self._waiting.append(job)
            self._forget_old()
            self._changed.notify()
            return job.to_json()

    def cancel(self, identity: str) -> dict[str, object]:
        """Stop a job, or take it out of the queue, and return it.

        Raises:
            RequestError: There is no such job, or it has ended.
        """
        with self._changed:
            job = self._jobs.get(identity)
            if job is None:
                raise missing(f"job {identity!r}")
            if job.state not in ("queued", "running"):
                raise conflict(f"job {identity} has ended: {job.state}")
            job.is_unwanted = True
            if job.state == "queued":
                self._waiting.remove(job)
                job.state, job.ended_s = "cancelled", time.monotonic()
            return job.to_json()

    def close(self) -> None:
        """Kill what runs, forget what waits."""
        with self._changed:
            self._is_closing = True
            self._waiting.clear()
            self._changed.notify()
        self._thread.join()

    def _free_id(self, name: str) -> str:
        """Return a name for a folder that nothing has yet."""
        wish = _UNWANTED.sub("-", name).strip(".-_")[:60] or "run"
        taken = {job.run for job in self._jobs.values() if job.state in ("queued", "running")}
        number, found = 1, wish
        while found in taken or (self._library.root / found).exists():
            number += 1
            found = f"{wish}-{number}"
        return found

    def _forget_old(self) -> None:
        ended = [job.id for job in self._jobs.values() if job.ended_s is not None]
        for identity in ended[: max(0, len(self._jobs) - MAX_KEPT)]:
            del self._jobs[identity]

    def _work(self) -> None:
        while (job := self._next()) is not None:
            folder = Path(tempfile.mkdtemp(prefix="ncsim-view-"))
            try:
                self._carry_out(job, folder)
            except Exception as error:  # the queue goes on whatever happens
                self._finish(job, "failed", f"{type(error).__name__}: {error}")
            finally:
                shutil.rmtree(folder, ignore_errors=True)

    def _next(self) -> Job | None:
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._is_closing)
            if self._is_closing:
                return None
            job = self._waiting.popleft()
            job.state, job.started_s = "running", time.monotonic()
            job.progress = Progress()
            return job

    def _carry_out(self, job: Job, folder: Path) -> None:
        scenario = folder / f"{job.run}.yaml"
        scenario.write_text(job.yaml, encoding="utf-8")
        target = self._library.root / job.run
        arguments = ("run", str(scenario), "-o", str(target), "--quiet")
        process = LimitedProcess(self.limits, ENTRY, *arguments)
        try:
            code = self._watched(job, process)
            self._conclude(job, process, code)
        finally:
            process.close()
            for left in self._library.root.glob(f".{job.run}.partial-{process.id}-*"):
                shutil.rmtree(left, ignore_errors=True)

    def _watched(self, job: Job, process: LimitedProcess) -> int | None:
        """Return the exit code of a process; ``None`` if the server closes."""
        while (code := process.poll()) is None:
            if self._is_closing:
                return None
            if job.is_unwanted:
                process.interrupt("cancelled")
            if job.progress is not None:
                job.progress.look(self._library, job.run)
            time.sleep(LOOK_EVERY_s)
        return code

    def _conclude(self, job: Job, process: LimitedProcess, code: int | None) -> None:
        if code in (ExitCode.OK, ExitCode.RUN_DID_NOT_COMPLETE):
            status = self._entries.entry(self._library.run(job.run))["status"]
            job.status = str(status)
            if job.progress is not None:
                job.progress.look(self._library, job.run)
            self._finish(job, "ended", "")
        elif code is None or process.interrupted == "cancelled":
            self._finish(job, "cancelled", "")
        else:
            self._finish(job, "failed", self._reason(process, code))

    def _reason(self, process: LimitedProcess, code: int) -> str:
        """Return why a run failed, for people."""
        said = process.complaint()
        if process.interrupted == "out of time":
            return f"stopped after {self.limits.wall_s:g} s, the limit of ncsim view --max-wall"
        if "MemoryError" in said:
            return f"needs more than {self.limits.memory_MB} MB, the limit of ncsim view"
        return said or f"the process ended with code {code} and said nothing"

    def _finish(self, job: Job, state: State, message: str) -> None:
        with self._changed:
            job.state, job.message, job.ended_s = state, message, time.monotonic()
