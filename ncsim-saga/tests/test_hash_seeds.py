"""No placement depends on PYTHONHASHSEED, though SAGA walks sets."""

import json
import os
import subprocess
import sys

import pytest
from ncsim_saga.catalogue import SCHEDULERS
from ncsim_saga.hash_order import name_hash, pair_hash

TINY = {"brute_force", "smt"}
PLAN_ALL = """
import json, sys
from ncsim_core.registry import load_registry
from ncsim_core.testing.builders import chain, dag_of, make_context, make_snapshot, network_of
from ncsim_core.errors import PlacementError

registry = load_registry()
edges = [(0, 1), (0, 2), (0, 3), (1, 4), (1, 5), (2, 5), (2, 6), (3, 6), (4, 7), (5, 7), (6, 7)]
wide = network_of(
    [None] * 5, [(a, b) for a in range(5) for b in range(a)], capacities=[100.0, 100.0, 150.0]
)
narrow = network_of([None] * 2, [(0, 1)], capacities=[100.0, 150.0])
answers = {}
for name in sys.argv[1:]:
    tiny = name in ("brute_force", "smt")
    network, dag = (narrow, chain(2)) if tiny else (wide, dag_of(edges, tasks=8))
    context = make_context(network)
    scheduler, _ = registry.build("scheduler", name, {}, context)
    try:
        plan = dict(scheduler.schedule(dag, make_snapshot(network)).nodes)
    except PlacementError as error:
        plan = str(error)
    answers[name] = plan
print(json.dumps(answers))
"""


def names():
    return [entry.name for entry in SCHEDULERS.values() if not entry.requires]


def plans(seed):
    done = subprocess.run(
        [sys.executable, "-c", PLAN_ALL, *names()],
        env=os.environ | {"PYTHONHASHSEED": seed},
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def by_seed():
    return {seed: plans(seed) for seed in ("0", "12345")}


def test_all_22_published_schedulers_are_there():
    assert len(names()) == 22


@pytest.mark.parametrize("name", names())
def test_placements_are_the_same_under_every_hash_seed(name, by_seed):
    assert by_seed["0"][name] == by_seed["12345"][name]


@pytest.mark.parametrize("name", sorted(set(names()) - {"hbmct"}))
def test_every_scheduler_places_every_task(name, by_seed):
    assert len(by_seed["0"][name]) == (2 if name in TINY else 8)


def test_hashes_are_those_of_seed_zero():
    words = ["n0", "node_12", "T3", "ünïcode", "長い名前", "x" * 100]
    code = (
        "import json, sys; w = json.loads(sys.argv[1]); "
        "print(json.dumps([[hash(x), hash((x, w[0]))] for x in w]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, json.dumps(words)],
        env=os.environ | {"PYTHONHASHSEED": "0"},
        capture_output=True,
        text=True,
        check=True,
    )

    assert json.loads(done.stdout) == [[name_hash(w), pair_hash(w, words[0])] for w in words]
