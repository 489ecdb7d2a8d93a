"""Appendix B of the paper: a two-hop route, sharing, and FIFO compute, event by event."""

from ncsim_core.engine.observer import Observer
from ncsim_core.engine.outcome import RunStatus
from ncsim_core.testing.worked_example import worked_example


class Diary(Observer):
    def __init__(self):
        self.lines = []

    def task_started(self, at_us, task, node):
        self.lines.append((at_us / 1e6, "start", "ABCD"[task]))

    def task_ended(self, at_us, task, node):
        self.lines.append((at_us / 1e6, "end", "ABCD"[task]))

    def transfer_started(self, at_us, transfer, route, size_MB):
        self.lines.append((at_us / 1e6, "send", transfer, tuple(route)))

    def rates_assigned(self, at_us, cause, changes):
        rates = {change.transfer: change.rate_MBps for change in changes}
        self.lines.append((at_us / 1e6, "rates", cause.change, cause.transfer, rates))

    def transfer_ended(self, at_us, transfer):
        self.lines.append((at_us / 1e6, "arrive", transfer))


def run_example():
    diary = Diary()
    simulation = worked_example(diary)
    simulation.run()
    return simulation, diary.lines


def test_makespan_is_five_seconds():
    simulation, _ = run_example()

    assert simulation.outcome.status is RunStatus.COMPLETED
    assert simulation.outcome.makespan_us == 5_000_000


def test_links_serve_four_and_five_megabytes():
    simulation, _ = run_example()

    assert simulation.state.served_MB() == [4.0, 5.0]


def test_every_event_happens_as_printed():
    _, lines = run_example()

    assert lines == [
        (0.0, "start", "A"),
        (0.0, "start", "B"),
        (1.0, "end", "A"),
        (1.0, "send", 0, (0, 1)),
        (1.0, "rates", "start", 0, {0: 2.0}),
        (2.0, "end", "B"),
        (2.0, "send", 1, (1,)),
        (2.0, "rates", "start", 1, {0: 1.0, 1: 1.0}),
        (3.0, "arrive", 1),
        (3.0, "rates", "finish", 1, {0: 2.0}),
        (3.0, "start", "D"),
        (3.5, "arrive", 0),
        (4.0, "end", "D"),
        (4.0, "start", "C"),
        (5.0, "end", "C"),
    ]
