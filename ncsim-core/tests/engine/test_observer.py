"""Who watches rates is told the same, change by change or column by column."""

from io import StringIO

from hypothesis import given, settings
from ncsim_core.engine.observer import Observer, RateChange
from ncsim_core.testing.whole_runs import run_cases
from ncsim_core.trace.writer import TraceWriter


class ByChange(Observer):
    """Keeps what it is told as objects, and passes it on."""

    def __init__(self, other):
        self.told = []
        self.other = other

    def run_started(self, setup):
        self.other.run_started(setup)

    def rates_assigned(self, at_us, cause, changes):
        assert all(type(change) is RateChange for change in changes)
        self.told.append((at_us, cause, [tuple(change) for change in changes]))
        self.other.rates_assigned(at_us, cause, changes)

    def run_ended(self, outcome):
        self.other.run_ended(outcome)


class ByColumn(Observer):
    """Keeps what it is told in columns, and passes it on."""

    def __init__(self, other):
        self.told = []
        self.other = other

    def run_started(self, setup):
        self.other.run_started(setup)

    def rate_columns_assigned(self, at_us, cause, columns):
        self.told.append((at_us, cause, list(zip(*columns, strict=True))))
        self.other.rate_columns_assigned(at_us, cause, columns)

    def run_ended(self, outcome):
        self.other.run_ended(outcome)


@settings(max_examples=15, deadline=None)
@given(run_cases())
def test_columns_hold_what_changes_hold_and_traces_of_both_are_equal(case):
    texts = StringIO(), StringIO()
    by_change, by_column = ByChange(TraceWriter(texts[0])), ByColumn(TraceWriter(texts[1]))

    case.simulation(by_change, by_column).run()

    assert by_change.told == by_column.told
    assert texts[0].getvalue() == texts[1].getvalue()


@settings(max_examples=15, deadline=None)
@given(run_cases())
def test_transfers_are_told_in_order_of_their_number(case):
    watching = ByColumn(Observer())

    case.simulation(watching).run()

    for _, _, changes in watching.told:
        assert changes == sorted(changes, key=lambda change: change[0])
