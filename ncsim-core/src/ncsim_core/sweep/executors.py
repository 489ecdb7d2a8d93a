"""Where runs are carried out: any ``concurrent.futures.Executor``, by name.

A package offers one more through an entry point in the group ``ncsim.executors`` whose value is a
function from an ``ExecutorRequest`` to an executor.
"""

import importlib
import multiprocessing
import os
import time
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from dataclasses import dataclass
from importlib.metadata import entry_points
from typing import Any, Final, TypeAlias

from typing_extensions import override

from ncsim_core.errors import ScenarioError
from ncsim_core.sweep.worker import prepare_worker

ALONE_s: Final = 60.0
EXECUTOR_GROUP: Final = "ncsim.executors"


@dataclass(frozen=True)
class ExecutorRequest:
    """What the user asks of an executor.

    Args:
        workers: How many; ``None`` leaves it to the executor.
        address: Of an existing cluster.
    """

    workers: int | None = None
    address: str | None = None


ExecutorFactory: TypeAlias = Callable[[ExecutorRequest], Executor]


class SerialExecutor(Executor):
    """Runs at once, in this process."""

    workers = 1

    @override
    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> "Future[Any]":
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


class DaskExecutor(Executor):
    """Runs on an existing Dask cluster; needs ``ncsim-core[dask]``.

    Args:
        address: Of the scheduler, such as ``tcp://10.0.0.1:8786``.
    """

    def __init__(self, address: str) -> None:
        try:
            distributed: Any = importlib.import_module("distributed")
        except ImportError:
            raise ScenarioError(
                "executor dask needs the package distributed: pip install 'ncsim-core[dask]'"
            ) from None
        try:
            self._client = distributed.Client(address, timeout=10)
        except OSError as error:
            raise ScenarioError(f"no Dask scheduler answers at {address}: {error}") from error
        self._address = address
        self._inner = self._client.get_executor(pure=False)
        self.workers = max(1, sum(self._client.nthreads().values()))
        self._alone_since_s: float | None = None

    def trouble(self) -> str | None:
        """Return that the cluster has had no worker for a minute; asked now and then."""
        if self._client.nthreads():
            self._alone_since_s = None
            return None
        now_s = time.monotonic()
        self._alone_since_s = self._alone_since_s or now_s
        if now_s - self._alone_since_s < ALONE_s:
            return None
        return f"the Dask cluster at {self._address} has had no worker for {ALONE_s:.0f} s"

    @override
    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> "Future[Any]":
        future: Future[Any] = self._inner.submit(fn, *args, **kwargs)
        return future

    @override
    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        self._inner.shutdown(wait=wait)
        self._client.close()


def process_pool(request: ExecutorRequest) -> Executor:
    """Return a pool of new processes on this machine."""
    return ProcessPoolExecutor(
        request.workers or os.cpu_count(),
        mp_context=multiprocessing.get_context("spawn"),
        initializer=prepare_worker,
    )


def dask(request: ExecutorRequest) -> Executor:
    """Return an executor on the Dask cluster at the request's address.

    Raises:
        ScenarioError: There is no address, or no cluster there.
    """
    if request.address is None:
        raise ScenarioError("executor dask needs the address of a scheduler: --address tcp://...")
    return DaskExecutor(request.address)


BUILT_IN: Final[dict[str, ExecutorFactory]] = {
    "process": process_pool,
    "serial": lambda _: SerialExecutor(),
    "dask": dask,
}


def executor_factory(name: str) -> ExecutorFactory:
    """Return the factory of an executor.

    Raises:
        ScenarioError: There is none of that name.
    """
    if name in BUILT_IN:
        return BUILT_IN[name]
    offered = {each.name: each for each in entry_points(group=EXECUTOR_GROUP)}
    if name in offered:
        factory: ExecutorFactory = offered[name].load()
        return factory
    raise ScenarioError(f"no executor {name!r}; there are {', '.join([*BUILT_IN, *offered])}")


def parallelism(executor: Executor, request: ExecutorRequest) -> int:
    """Return how many runs an executor can do at a time, as far as it tells."""
    own = getattr(executor, "workers", None) or getattr(executor, "_max_workers", None)
    return int(own or request.workers or os.cpu_count() or 1)
