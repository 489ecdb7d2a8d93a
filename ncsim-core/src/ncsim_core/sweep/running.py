"""``run_sweep``: the runs of a sweep, as they finish, and the table of all."""

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, Self

from ncsim_core.errors import EngineError, NcsimError, ScenarioError
from ncsim_core.sweep.axes import Run
from ncsim_core.sweep.dispatch import Dispatcher
from ncsim_core.sweep.executors import ExecutorFactory, ExecutorRequest, executor_factory
from ncsim_core.sweep.plan import SweepPlan
from ncsim_core.sweep.reading import load_sweep
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.sweep.store import Store
from ncsim_core.sweep.table import Table, record_of, table_of
from ncsim_core.sweep.worker import Item, ResultRow, failed_row

LOOKAHEAD = 256
"""Runs whose keys are looked up together."""


@dataclass(frozen=True)
class SweepOptions:
    """How a sweep is carried out; nothing here changes a result.

    Args:
        workers: Processes; by default one per processor.
        executor: ``process``, ``serial``, ``dask``, or one that a package offers.
        address: Of an existing cluster.
        shard: ``(i, n)`` does every n-th run only, beginning with the i-th.
        retry_failed: Do runs again that failed or reached a limit.
    """

    workers: int | None = None
    executor: str = "process"
    address: str | None = None
    shard: tuple[int, int] | None = None
    retry_failed: bool = False

    def __post_init__(self) -> None:
        if self.shard is not None and not 1 <= self.shard[0] <= self.shard[1]:
            raise ScenarioError(f"shard {self.shard[0]}/{self.shard[1]}: give i/n, 1 <= i <= n")


class SweepResults:
    """The runs of a sweep: iterate to carry it out, then ask for the table.

    Args:
        plan: The sweep.
        store: Where results are kept.
        options: How it is carried out.
    """

    def __init__(self, plan: SweepPlan, store: Store, options: SweepOptions) -> None:
        self.plan = plan
        self.total = sum(1 for _ in plan.runs())
        self._store = store
        self._options = options
        self._factory: ExecutorFactory = executor_factory(options.executor)
        self._members: dict[str, list[Run]] = {}
        self._ready: list[tuple[Run, ResultRow]] = []
        self._is_done = False

    @property
    def planned(self) -> int:
        """Return how many runs this call is to do or find."""
        if self._options.shard is None:
            return self.total
        first, count = self._options.shard
        return len(range(first - 1, self.total, count))

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Yield each run as a mapping: values by column, seed, status, makespan, and so on.

        Raises:
            ScenarioError: Results cannot be written.
            NcsimError: Workers do not start, or none is left.
        """
        self._members, self._ready = {}, []  # an earlier walk may have been left half-way
        self._store.register(self.plan, self.total)
        request = ExecutorRequest(self._options.workers, self._options.address)
        items = self._items()
        first = next(items, None)
        yield from self._taken()
        if first is not None:
            dispatcher = Dispatcher(self.plan, self._factory, request)
            for rows in dispatcher.results(_chained(first, items)):
                self._store.save(rows)
                for row in rows:
                    for run in self._members.pop(row.key, ()):
                        yield record_of(self.plan, run.values, run.seed, row)
                yield from self._taken()
            if self._members:
                raise EngineError(f"the sweep ended with {len(self._members)} runs not done")
        self._is_done = True

    def table(self) -> Table:
        """Return all runs in the order of the file, carrying out what is still to be done."""
        if not self._is_done:
            for _ in self:
                pass
        return table_of(self._store)

    def close(self) -> None:
        """Let go of the study's file."""
        self._store.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _taken(self) -> Iterator[dict[str, Any]]:
        """Yield the runs whose results were there already."""
        ready, self._ready = self._ready, []
        for run, row in ready:
            yield record_of(self.plan, run.values, run.seed, row)

    def _items(self) -> Iterator[Item]:
        """Yield the runs that are to be done, each key once."""
        resolver = Resolver(self.plan)
        runs = self._own_runs()
        while batch := list(islice(runs, LOOKAHEAD)):
            items = [self._item(run, resolver) for run in batch]
            self._store.enrol(self.plan, items)
            keys = list({item.key for item in items})
            found = self._store.finished(keys, retry_failed=self._options.retry_failed)
            for item in items:
                if item.key in found:
                    self._ready.append((item.run, found[item.key]))
                elif item.key in self._members:
                    self._members[item.key].append(item.run)
                else:
                    self._members[item.key] = [item.run]
                    yield item

    def _item(self, run: Run, resolver: Resolver) -> Item:
        """Return a run with its key; a run that has no scenario is a failed run at once."""
        try:
            return Item(resolver.key(run), run)
        except NcsimError as error:
            key = f"unresolved:{self.plan.digest}:{run.number}"
            self._store.save([failed_row(key, str(error))])
            return Item(key, run)

    def _own_runs(self) -> Iterator[Run]:
        if self._options.shard is None:
            return self.plan.runs()
        first, count = self._options.shard
        return islice(self.plan.runs(), first - 1, None, count)


def run_sweep(
    sweep: str | os.PathLike[str] | Mapping[str, Any] | SweepPlan,
    output: str | os.PathLike[str] | None = None,
    options: SweepOptions | None = None,
    **changes: Any,  # noqa: ANN401 - the fields of SweepOptions
) -> SweepResults:
    """Return the runs of a sweep; they are carried out as they are asked for.

    A script that uses worker processes must guard its main part with
    ``if __name__ == "__main__":``, as for every process pool.

    Args:
        sweep: A sweep file, the same as plain data, or a plan.
        output: Folder of the study; results that it holds are reused. ``None`` keeps results in
            memory.
        options: How it is carried out.
        **changes: Single options, such as ``workers=2`` or ``executor="serial"``.

    Raises:
        ScenarioError: The sweep is wrong, or the study cannot be opened.
    """
    plan = sweep if isinstance(sweep, SweepPlan) else load_sweep(sweep)
    chosen = options or SweepOptions(**changes)
    executor_factory(chosen.executor)  # before there is a study
    store = Store(None if output is None else Path(output))
    try:
        return SweepResults(plan, store, chosen)
    except BaseException:
        store.close()
        raise


def _chained(first: Item, rest: Iterator[Item]) -> Iterator[Item]:
    yield first
    yield from rest
