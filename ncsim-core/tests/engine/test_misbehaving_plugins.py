"""Each method of each contract raises or answers with rubbish: the run ends, with a name."""

from dataclasses import replace

import pytest
from ncsim_core.contracts.interference_model import Competition, InterferenceSession
from ncsim_core.contracts.queue_model import QueueModel
from ncsim_core.engine.observer import Observer
from ncsim_core.engine.simulation import Simulation
from ncsim_core.errors import NcsimError
from ncsim_core.models import ComponentIdentity
from ncsim_core.testing.builders import chain, fork_join, inject, line
from ncsim_core.testing.toys import ToyRadio, ToyRelays, models

KINDS = (
    "scheduler",
    "routing_model",
    "interference_model",
    "queue_model",
    "dag_source",
)
RUBBISH = (None, 42, "n0", [], [None], {}, [(0, 1), 2], float("nan"))
NETWORK = line(3)


def raising(*_, **__):
    raise ZeroDivisionError("oops")


class Watching(Observer):
    """Wants rates, so that models are asked what links are up against, too."""


def answering(rubbish):
    return lambda *_, **__: rubbish


def sound_models(interference=None):
    dags = [
        inject(fork_join(3, cost=10.0, pins={0: 0, 1: 1, 2: 2, 3: 2, 4: 0})),
        inject(chain(3, dag_id="later"), 0.05),
    ]
    interference = interference or ToyRadio({0: [1], 1: [0], 2: [3], 3: [2]})
    who = models(NETWORK, dags, interference=interference)
    names = {kind: ComponentIdentity(kind, f"my_{kind}", "my-package", "1.2") for kind in KINDS}
    return replace(who, identities=names)


class Session(InterferenceSession):
    """A sound session whose methods can be replaced."""

    def __init__(self, inner):
        self.inner = inner

    def update(self, on, off):
        return self.inner.update(on, off)

    def competition(self, links):
        return self.inner.competition(links)


def with_method(component, method, replacement):
    setattr(component, method, replacement)
    return component


def with_session(who, method, replacement):
    model = who.interference
    session = with_method(Session(model.open_session()), method, replacement)
    return replace(who, interference=with_method(model, "open_session", lambda: session))


def with_queue(who, method, replacement):
    make = who.new_queue

    def new_queue():
        queue = make()
        kind = type("Odd", (type(queue),), {method: replacement})
        return with_class(queue, kind)

    return replace(who, new_queue=new_queue)


def with_class(queue: QueueModel, kind):
    queue.__class__ = kind
    return queue


def relayed(replacement):
    return with_method(ToyRelays(NETWORK), "route_rates", replacement)


PLANTED = {
    "schedule": (
        "scheduler",
        lambda bad: with_part("scheduler", "schedule", bad),
    ),
    "routes_from": ("routing_model", lambda bad: with_part("routing", "routes_from", bad)),
    "route": ("routing_model", lambda bad: with_part("routing", "route", bad)),
    "factors": ("interference_model", lambda bad: with_part("interference", "factors", bad)),
    "reach": ("interference_model", lambda bad: with_part("interference", "reach", bad)),
    "open_session": (
        "interference_model",
        lambda bad: with_part("interference", "open_session", bad),
    ),
    "tables": ("interference_model", lambda bad: with_part("interference", "tables", bad)),
    "competition": (
        "interference_model",
        lambda bad: with_part("interference", "competition", bad),
    ),
    "session.update": (
        "interference_model",
        lambda bad: with_session(sound_models(), "update", bad),
    ),
    "session.competition": (
        "interference_model",
        lambda bad: with_session(sound_models(), "competition", bad),
    ),
    "route_rates": ("interference_model", lambda bad: sound_models(relayed(bad))),
    "push": ("queue_model", lambda bad: with_queue(sound_models(), "push", bad)),
    "pop": ("queue_model", lambda bad: with_queue(sound_models(), "pop", bad)),
    "new_queue": ("queue_model", lambda bad: replace(sound_models(), new_queue=bad)),
    "injections": ("dag_source", lambda bad: with_part("dag_source", "injections", bad)),
}


def with_part(part, method, replacement):
    who = sound_models()
    with_method(getattr(who, part), method, replacement)
    return who


def ending(who):
    """Return what the user is told: an error at the start, or the status and its detail."""
    try:
        outcome = Simulation(NETWORK, who, observers=[Watching()]).run()
    except NcsimError as error:
        return "failed", str(error)
    return str(outcome.status), outcome.detail


def test_without_a_fault_the_run_completes():
    assert ending(sound_models()) == ("completed", "")
    assert ending(sound_models(ToyRelays(NETWORK))) == ("completed", "")


@pytest.mark.parametrize("method", PLANTED)
def test_what_a_plugin_raises_ends_the_run_and_names_it(method):
    kind, plant = PLANTED[method]

    status, detail = ending(plant(raising))

    assert status == "failed"
    assert f"{kind} 'my_{kind}' (my-package 1.2)" in detail
    assert "ZeroDivisionError: oops" in detail


@pytest.mark.parametrize("rubbish", RUBBISH, ids=repr)
@pytest.mark.parametrize("method", PLANTED)
def test_rubbish_from_a_plugin_ends_the_run_and_names_it_or_means_something(method, rubbish):
    kind, plant = PLANTED[method]

    status, detail = ending(plant(answering(rubbish)))

    if status == "failed":
        assert f"{kind} 'my_{kind}' (my-package 1.2)" in detail
        assert "internal" not in detail
    else:  # no DAGs, nothing to wait for, no route: answers that a plug-in may give
        assert (method, repr(rubbish)) in MEANINGFUL or method == "push"


@pytest.mark.parametrize(
    "nonsense",
    [Competition(-1), Competition(1.0), Competition(0, "2"), Competition(0, 0, float("nan"))],
    ids=repr,
)
def test_competition_is_two_counts_and_a_factor(nonsense):
    kind, plant = PLANTED["session.competition"]

    status, detail = ending(plant(lambda links, *_: [nonsense] * len(links)))

    assert status == "failed"
    assert f"{kind} 'my_{kind}' (my-package 1.2): competition() gave {nonsense!r}" in detail


MEANINGFUL = {
    ("injections", "[]"),
    ("injections", "{}"),
    ("route", "None"),
    ("tables", "None"),
}
