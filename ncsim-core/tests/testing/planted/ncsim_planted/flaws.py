"""Flaws that a component of any kind can have, put upon good components."""

import random
from dataclasses import replace

import numpy as np
from ncsim_core.builtin.dag_sources import MultiDAGSource
from ncsim_core.builtin.link_models import StaticLinkModel
from ncsim_core.builtin.queue_models import FifoQueue
from ncsim_core.builtin.schedulers import RoundRobinScheduler
from ncsim_core.network import LinkRates
from ncsim_core.testing.oracle import FewestHops
from ncsim_core.workflow import PlacementPlan

from ncsim_planted.interference_models import TakeTurns

HASH_DECIDED = min(range(100_000), key=lambda number: hash(str(number)))
"""A number that depends on the hash seed."""


class Routing(FewestHops):
    def __init__(self, context):
        self.context = context


GOOD = {
    "scheduler": (RoundRobinScheduler, "schedule"),
    "routing_model": (Routing, "route"),
    "link_model": (StaticLinkModel, "rate_links"),
    "interference_model": (TakeTurns, "factors"),
    "queue_model": (FifoQueue, "push"),
    "dag_source": (MultiDAGSource, "injections"),
}


def make(context, kind, level=2):
    return GOOD[kind][0](context)


def make_flawed(context, kind, flaw):
    good, method = GOOD[kind]
    original = getattr(good, method)

    def answer(self, *arguments):
        return FLAWS[flaw](context, kind, lambda *given: original(self, *given), arguments)

    component = type("Flawed", (good,), {method: answer})(context)
    if flaw == "pickled_copy_gives_same_answer":
        component.hook = lambda: None
    return component


def uses_generators(context, kind, ask, arguments):
    random.random()
    np.random.rand()
    return ask(*arguments)


def changes_arguments(context, kind, ask, arguments):
    context.network.node_index["stranger"] = 0
    return ask(*arguments)


def remembers(context, kind, ask, arguments):
    remembers.calls = getattr(remembers, "calls", 0) + 1
    return altered(remembers.calls, kind, ask, arguments)


def asks_hash(context, kind, ask, arguments):
    return altered(HASH_DECIDED, kind, ask, arguments)


def breaks_down(context, kind, ask, arguments):
    raise RuntimeError("out of order")


def is_plain(context, kind, ask, arguments):
    return ask(*arguments)


FLAWS = {
    "same_question_same_answer": remembers,
    "global_generators_stay_untouched": uses_generators,
    "arguments_stay_unchanged": changes_arguments,
    "pickled_copy_gives_same_answer": is_plain,
    "hash_seed_changes_nothing": asks_hash,
    "runs_obey_the_rules": breaks_down,
    "equal_runs_leave_equal_traces": remembers,
}


def altered(number, kind, ask, arguments):
    """Return an answer into which a number has found its way."""
    return ALTERED[kind](number, ask, *arguments)


def altered_plan(number, ask, dag, snapshot):
    nodes = snapshot.network.nodes
    plan = {}
    for task in dag.tasks:
        number, digit = divmod(number, len(nodes))
        plan[task.id] = nodes[digit].id
    return PlacementPlan(plan)


def altered_route(number, ask, source, target, network):
    bit = source * len(network.nodes) + target
    return None if number >> bit & 1 else ask(source, target, network)


def altered_rates(number, ask, network):
    rates = ask(network)
    return LinkRates.of([each + number for each in rates.bandwidth_MBps], rates.latency_s)


def altered_factors(number, ask, links, active):
    return ask(links, active) / (1 + number)


def altered_push(number, ask, task):
    ask(replace(task, compute_cost=task.compute_cost + number))


def altered_injections(number, ask):
    return [replace(each, at_us=each.at_us + number) for each in ask()]


ALTERED = {
    "scheduler": altered_plan,
    "routing_model": altered_route,
    "link_model": altered_rates,
    "interference_model": altered_factors,
    "queue_model": altered_push,
    "dag_source": altered_injections,
}
