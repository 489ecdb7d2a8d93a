"""What runs of one process have in common, and that having it changes no result."""

import pytest
from ncsim_core.api import simulate
from ncsim_core.context import ModelCache
from ncsim_core.scenario import assembly
from ncsim_core.scenario.assembly import assemble
from ncsim_core.sweep.reading import load_sweep
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.sweep.running import run_sweep
from ncsim_core.testing.fixtures import DECLARATION, fake_dist

__all__ = ["fake_dist"]

ROUTING = (
    DECLARATION
    + """
from ncsim_core.testing.oracle import FewestHops

ASKED = []


@hookimpl
def ncsim_components():
    return [
        Component("routing_model", "counted", "counted:Counted", "Counts.",
                  capabilities=frozenset({"pure"})),
        Component("routing_model", "secretive", "counted:Counted", "Counts, says nothing."),
    ]


class Counted(FewestHops):
    def __init__(self, context):
        pass

    def routes_from(self, source, network):
        ASKED.append(source)
        return super().routes_from(source, network)
"""
)
LISTENER = (
    DECLARATION
    + """
HEARD = []


@hookimpl
def ncsim_run_started(run):
    HEARD.append((run.scenario_name, run.seed, run.identities["scheduler"].name))


@hookimpl
def ncsim_run_finished(run, status, makespan_s):
    HEARD.append((run.seed, status, makespan_s))
"""
)


@pytest.fixture(autouse=True)
def no_routes_yet(monkeypatch):
    monkeypatch.setattr(assembly, "ROUTE_TABLES", ModelCache(max_entries=8))


def sweep(routing, vary=None, **more):
    base = {
        "network": {"type": "line", "nodes": 4, "bandwidth_MBps": 1},
        "dags": {"type": "fork_join", "width": 3},
        "config": {"scheduler": "round_robin", "routing": routing, "link_model": "wifi"},
    }
    return {"sweep": {"base": base, "vary": vary or {}, **more}}


def done(document):
    with run_sweep(document, executor="serial") as results:
        return results.table().to_dicts()


def test_a_pure_model_is_asked_once_per_network(fake_dist):
    fake_dist("counted", {"counted": ROUTING})
    from counted import ASKED

    vary = {"interference": ["none", "csma_bianchi"], "scheduler": ["round_robin", "heft"]}
    rows = done(sweep("counted", vary, replicate={"seeds": 3}))

    assert {row["status"] for row in rows} == {"completed"}
    assert sorted(ASKED) == [0, 1, 2, 3]


def test_a_model_that_does_not_say_so_is_asked_by_every_run(fake_dist):
    fake_dist("counted", {"counted": ROUTING})
    from counted import ASKED

    done(sweep("secretive", replicate={"seeds": 3}))

    assert ASKED.count(0) == 3


def test_shared_routes_depend_on_all_that_makes_them():
    vary = {
        "network.bandwidth_MBps": [None, 3],
        "network.range_m": [60, 75],
        "routing": ["minimum_hop", "widest_path", "direct"],
        "rf.tx_power_dBm": [17, 20],
        "interference": ["none", "csma_bianchi"],
    }
    base = {
        "network": {"type": "random_geometric", "nodes": 7, "side_m": 90, "range_m": 60},
        "dags": {"type": "layered_random", "layers": 3, "width": 3},
        "config": {"scheduler": "heft", "link_model": "wifi"},
    }
    plan = load_sweep({"sweep": {"base": base, "vary": vary, "replicate": {"seeds": 2}}})
    with run_sweep(plan, executor="serial") as results:
        shared = {(tuple(row[c] for c in plan.columns), row["seed"]): row for row in results}
    resolver = Resolver(plan)
    for run in plan.runs():
        assembly.ROUTE_TABLES = ModelCache()  # as if it were the only one
        alone = simulate(resolver.scenario(run))

        row = shared[run.values, run.seed]
        assert (row["status"], row["makespan_s"]) == (str(alone.status), alone.makespan_s)
        assert row["route_work_MB_hops"] == alone.route_work_MB_hops


def test_a_conflict_graph_is_worked_out_once_for_all_policies(monkeypatch):
    from ncsim_wifi import conflict

    made, original = [], conflict.relations_of

    def counted(*args):
        made.append(1)
        return original(*args)

    monkeypatch.setattr(conflict, "relations_of", counted)
    vary = {"scheduler": ["round_robin", "heft", "cpop"], "dags.width": [2, 3]}
    document = sweep("minimum_hop", vary)
    base = document["sweep"]["base"]
    base["network"] = {"type": "line", "nodes": 4, "spacing_m": 33.25}  # new to this process
    base["config"]["interference"] = "csma_bianchi"
    done(document)

    assert len(made) == 1


def test_plugins_are_told_of_every_run_of_a_sweep(fake_dist):
    fake_dist("listener", {"listener": LISTENER})
    from listener import HEARD

    rows = done(sweep("minimum_hop", replicate={"seeds": [5, 6]}))

    makespan_s = rows[0]["makespan_s"]
    assert [
        ("sweep", 5, "round_robin"),
        (5, "completed", makespan_s),
        ("sweep", 6, "round_robin"),
        (6, "completed", makespan_s),
    ] == HEARD


def test_plugins_are_told_of_a_run_from_python_and_of_one_that_hits_its_limit(fake_dist):
    fake_dist("listener", {"listener": LISTENER})
    from listener import HEARD
    from ncsim_core import Limits

    plan = load_sweep(sweep("minimum_hop"))
    scenario = Resolver(plan).scenario(next(plan.runs()))
    simulate(scenario, limits=Limits(max_events=2), seed=9)

    assert HEARD == [("sweep", 9, "round_robin"), (9, "limit_reached", None)]


def test_names_are_no_part_of_what_identifies_a_result(tmp_path):
    def keys(document):
        plan = load_sweep(document)
        return [Resolver(plan).key(run) for run in plan.runs()]

    document = sweep("minimum_hop", replicate={"seeds": 2})
    named = {"sweep": {"name": "other", "description": "words", **document["sweep"]}}

    assert keys(document) == keys(named)
    assert len(set(keys(document))) == 2


@pytest.mark.parametrize(
    "change",
    [
        {"network.nodes": [5]},
        {"network.latency_s": [0.1]},
        {"dags.payload_MB": [11]},
        {"dags.inject_every_s": [1.0], "dags.count": [2]},
        {"routing": ["widest_path"]},
        {"rf.tx_power_dBm": [19]},
        {"interference": ["csma_bianchi"]},
    ],
    ids=str,
)
def test_everything_else_is(change):
    def key(document):
        plan = load_sweep(document)
        return Resolver(plan).key(next(plan.runs()))

    assert key(sweep("minimum_hop")) != key(sweep("minimum_hop", change))


def test_an_assembly_of_the_same_network_and_model_has_the_same_table():
    plan = load_sweep(sweep("minimum_hop", {"interference": ["none", "csma_bianchi"]}))
    resolver = Resolver(plan)
    solo, full = (assemble(resolver.scenario(run)).models.routes for run in plan.runs())

    assert solo is not None
    assert solo is full
