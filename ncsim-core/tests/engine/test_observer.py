"""Who watches in batches is told what others are told at once, in the same order."""

import pytest
from hypothesis import given, settings
from ncsim_core.engine import simulation as simulation_module
from ncsim_core.engine.events import (
    DAG_INJECT,
    TASK_COMPLETE,
    TASK_READY,
    TASK_START,
    TRANSFER_COMPLETE,
    TRANSFER_START,
)
from ncsim_core.engine.observer import BatchObserver, Observer, RateCause, RateChange, changes_of
from ncsim_core.testing.whole_runs import run_cases
from ncsim_core.testing.worked_example import worked_example


class AtOnce(Observer):
    """Keeps what it is told."""

    def __init__(self):
        self.told = []

    def dag_injected(self, at_us, dag, nodes):
        self.told.append((at_us, DAG_INJECT, dag))

    def task_ready(self, at_us, task, node):
        self.told.append((at_us, TASK_READY, task))

    def task_started(self, at_us, task, node):
        self.told.append((at_us, TASK_START, task))

    def task_ended(self, at_us, task, node):
        self.told.append((at_us, TASK_COMPLETE, task))

    def transfer_started(self, at_us, transfer, route, size_MB):
        self.told.append((at_us, TRANSFER_START, transfer))

    def transfer_ended(self, at_us, transfer):
        self.told.append((at_us, TRANSFER_COMPLETE, transfer))

    def rates_assigned(self, at_us, cause, changes):
        assert all(type(change) is RateChange for change in changes)
        self.told.append((at_us, cause, changes))


class InBatches(BatchObserver):
    """Keeps what it is told, as if it had been at once."""

    def __init__(self):
        self.told = []
        self.sizes = []

    def dag_injected(self, at_us, dag, nodes):
        self.told.append((at_us, DAG_INJECT, dag))

    def events_happened(self, batch):
        self.sizes.append(len(batch.events))
        for place, (at_us, kind, _, number) in enumerate(batch.events):
            if kind != DAG_INJECT:
                self.told.append((at_us, kind, number))
            if place in batch.rates:
                cause = RateCause("start" if kind == TRANSFER_START else "finish", number)
                self.told.append((at_us, cause, changes_of(batch.rates[place])))


@settings(max_examples=40, deadline=None)
@given(run_cases())
def test_batches_hold_what_others_are_told_at_once(case):
    at_once, in_batches = AtOnce(), InBatches()

    case.simulation(at_once, in_batches).run()

    assert in_batches.told == at_once.told


@settings(max_examples=15, deadline=None)
@given(run_cases())
def test_each_step_is_told_before_the_next(case):
    at_once, in_batches = AtOnce(), InBatches()
    simulation = case.simulation(at_once, in_batches)

    while simulation.step() is not None:
        assert in_batches.told == at_once.told


@settings(max_examples=15, deadline=None)
@given(run_cases())
def test_transfers_are_told_in_order_of_their_number(case):
    watching = AtOnce()

    case.simulation(watching).run()

    for _, cause, changes in watching.told:
        if isinstance(cause, RateCause):
            assert changes == sorted(changes, key=lambda change: change.transfer)


@pytest.mark.parametrize("lag_s", [0.0, 1e9])
def test_batches_stay_small_where_events_take_long(lag_s, monkeypatch):
    monkeypatch.setenv("NCSIM_PURE", "1")  # the compiled loop takes no time
    monkeypatch.setattr(simulation_module, "LAG_s", lag_s)
    in_batches = InBatches()

    worked_example(in_batches).run()

    assert sum(in_batches.sizes) == 17
    assert (max(in_batches.sizes) == 1) == (lag_s == 0.0)
