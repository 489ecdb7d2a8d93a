"""What a trace has told so far about transfers, and what may not follow from it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from ncsim_core.trace.loading import rate_steps
from ncsim_core.trace.records import (
    Ended,
    Injected,
    RatesAssigned,
    TracePreamble,
    TransferEnded,
    TransferStarted,
)
from ncsim_core.trace.run_trace import RateStep
from ncsim_core.trace.task_ledger import Find, TaskLedger
from ncsim_core.units import MICROSECONDS_PER_SECOND, us_from_s

RELATIVE_TOLERANCE: Final = 1e-6
"""Of a transfer's size: what adding up its service may be off."""

RATE_TOLERANCE: Final = 1e-9
"""Of a link's bandwidth: what the sum of rates may be off."""


@dataclass
class TransferEntry:
    """A dependency as far as the trace has told."""

    source: int
    target: int
    size_MB: float
    route: Sequence[int] = ()
    started_us: int | None = None
    ended_us: int | None = None
    rate_MBps: float = 0.0
    credited_us: int = 0
    served_MB: float = 0.0


class TransferLedger:
    """Follows transfers, and adds up what each has been served.

    Args:
        preamble: The links, and whether rates are recorded.
        tasks: The tasks that transfers run between.
        find: Takes what is wrong.
    """

    def __init__(self, preamble: TracePreamble, tasks: TaskLedger, find: Find) -> None:
        self._links = preamble.links
        self._has_rates = preamble.level == "full"
        self._tasks = tasks
        self._find = find
        self._flows: list[dict[int, None]] = [{} for _ in preamble.links]
        self._outgoing: dict[int, list[int]] = {}
        self._latest: tuple[str, int, int] | None = None
        self.entries: list[TransferEntry] = []

    def inject(self, record: Injected) -> None:
        """Enter the dependencies of a DAG."""
        for source, target, size_MB in record.edges:
            if max(source, target) >= len(self._tasks.entries):
                self._find(f"edge {source} -> {target} ends at a task that is not listed")
                continue
            self._outgoing.setdefault(source, []).append(len(self.entries))
            self.entries.append(TransferEntry(source, target, size_MB))

    def deliver_locally(self, record: Ended) -> None:
        """Enter that a task's results are there for tasks on the same node."""
        for number in self._outgoing.get(record.task, ()):
            if self._is_local(self.entries[number]):
                self._tasks.arrive(self.entries[number].target, record.at_us)

    def start(self, record: TransferStarted) -> None:
        """Check and enter that a transfer's bytes begin to be served."""
        entry, name = self.entries[record.transfer], self._name(record.transfer)
        if entry.started_us is not None:
            self._find(f"transfer {name} starts a second time")
        if record.size_MB != entry.size_MB:
            self._find(f"transfer {name} carries {record.size_MB} MB, its edge {entry.size_MB}")
        self._expect_producer_and_latency(entry, record, name)
        self._expect_route(entry, record.route, name)
        entry.route, entry.started_us, entry.credited_us = record.route, record.at_us, record.at_us
        self._occupy(record.transfer)
        self._latest = ("s", record.transfer, record.at_us)

    def assign(self, record: RatesAssigned) -> None:
        """Check and enter new rates, after crediting what was served at the old ones."""
        change, cause = record.cause
        if self._latest != (change, cause, record.at_us):
            word = "start" if change == "s" else "end"
            self._find(
                f"recalc is caused by the {word} of transfer {cause}, which is not just before"
            )
        for transfer, step in rate_steps(record):
            entry = self.entries[transfer]
            if entry.started_us is None or entry.ended_us is not None:
                self._find(f"transfer {self._name(transfer)} gets a rate while it is not served")
                continue
            self._credit(entry, record.at_us)
            self._expect_bottleneck(entry, step, self._name(transfer))
            entry.rate_MBps = step.rate_MBps
        self._expect_links_keep_up(record.transfers)

    def end(self, record: TransferEnded) -> None:
        """Check and enter that a transfer has been served, to the last byte and no more."""
        entry, name = self.entries[record.transfer], self._name(record.transfer)
        if entry.started_us is None or entry.ended_us is not None:
            self._find(f"transfer {name} ends without having started, or a second time")
            return
        self._credit(entry, record.at_us)
        if self._has_rates:
            tick_MB = entry.rate_MBps / MICROSECONDS_PER_SECOND
            if abs(entry.served_MB - entry.size_MB) > tick_MB + RELATIVE_TOLERANCE * entry.size_MB:
                self._find(f"transfer {name} was served {entry.served_MB} MB of {entry.size_MB}")
        entry.ended_us = record.at_us
        self._release(record.transfer)
        self._tasks.arrive(entry.target, record.at_us)
        self._latest = ("e", record.transfer, record.at_us)

    def expect_all_ended(self) -> None:
        """Check that every dependency between two nodes has become a transfer and ended."""
        for number, entry in enumerate(self.entries):
            if entry.ended_us is None and not self._is_local(entry):
                self._find(f"the run is completed, but transfer {self._name(number)} has not ended")

    def _expect_producer_and_latency(
        self, entry: TransferEntry, record: TransferStarted, name: str
    ) -> None:
        produced_us = self._tasks.entries[entry.source].ended_us
        if self._is_local(entry):
            self._find(f"transfer {name} runs between tasks on one node")
        if produced_us is None:
            self._find(f"transfer {name} starts before its producer has ended")
            return
        latency_us = us_from_s(math.fsum(self._links[link].latency_s for link in record.route))
        if record.at_us < produced_us + latency_us:
            self._find(f"transfer {name} starts before {produced_us} us plus {latency_us} latency")

    def _expect_route(self, entry: TransferEntry, route: Sequence[int], name: str) -> None:
        at = self._tasks.entries[entry.source].node
        for link in route:
            if self._links[link].source != at:
                self._find(f"transfer {name}: its route breaks at link {self._links[link].id!r}")
                return
            at = self._links[link].target
        if at != self._tasks.entries[entry.target].node:
            self._find(f"transfer {name}: its route does not lead to its task's node")

    def _expect_bottleneck(self, entry: TransferEntry, step: RateStep, name: str) -> None:
        link = self._links[step.bottleneck]
        if step.bottleneck not in entry.route:
            self._find(f"transfer {name}: bottleneck {link.id!r} is not on its route")
            return
        flows = len(self._flows[step.bottleneck])
        if step.flows != flows:
            self._find(f"transfer {name}: {step.flows} flows on {link.id!r} instead of {flows}")

    def _expect_links_keep_up(self, transfers: Sequence[int]) -> None:
        """Check that no link on the routes of these carries more than its bandwidth."""
        for index in sorted({link for number in transfers for link in self.entries[number].route}):
            link = self._links[index]
            carried_MBps = math.fsum(self.entries[each].rate_MBps for each in self._flows[index])
            if carried_MBps > link.bandwidth_MBps * (1 + RATE_TOLERANCE):
                self._find(
                    f"link {link.id!r} carries {carried_MBps} MB/s, more than its "
                    f"{link.bandwidth_MBps}"
                )

    def _credit(self, entry: TransferEntry, at_us: int) -> None:
        elapsed_us = at_us - entry.credited_us
        if elapsed_us:
            entry.served_MB += entry.rate_MBps * elapsed_us / MICROSECONDS_PER_SECOND
        entry.credited_us = at_us

    def _occupy(self, number: int) -> None:
        if self.entries[number].size_MB > 0:  # nothing to serve: it never occupies its route
            for link in self.entries[number].route:
                self._flows[link][number] = None

    def _release(self, number: int) -> None:
        for link in self.entries[number].route:
            self._flows[link].pop(number, None)

    def _is_local(self, entry: TransferEntry) -> bool:
        tasks = self._tasks.entries
        return tasks[entry.source].node == tasks[entry.target].node

    def _name(self, number: int) -> str:
        entry, tasks = self.entries[number], self._tasks.entries
        return f"{tasks[entry.source].name!r} -> {tasks[entry.target].name!r}"
