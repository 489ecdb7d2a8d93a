"""Draws of one thing disturb no other: placement, capacities, workload, shadowing."""

import pytest
from ncsim_core.scenario.assembly import assemble
from ncsim_core.sweep.reading import load_sweep
from ncsim_core.sweep.resolving import Resolver

RANGE = {"low": 80, "high": 300}


def scenarios(vary, seeds=2, **more):
    base = {
        "network": {
            "type": "random_geometric",
            "nodes": 6,
            "side_m": 60,
            "range_m": 90,
            "capacities": RANGE,
        },
        "dags": {
            "type": "layered_random",
            "layers": 3,
            "width": 3,
            "compute_cost": RANGE,
            "payload_MB": {"low": 1, "high": 9},
        },
        "config": {
            "link_model": "wifi",
            "routing": "minimum_hop",
            "rf": {"shadow_fading_sigma": 6},
        },
    }
    plan = load_sweep(
        {"sweep": {"base": base, "vary": vary, "replicate": {"seeds": seeds}, **more}}
    )
    resolver = Resolver(plan)
    found = {}
    for run in plan.runs():
        found.setdefault(run.seed, []).append(resolver.scenario(run))
    return found


def shadowed(scenario):
    """Return what the radio makes of the network, its shadowing drawn."""
    return assemble(scenario).network.bandwidth_MBps


@pytest.mark.parametrize(
    "vary",
    [
        {"dags.width": [2, 3, 4]},
        {"dags.compute_cost": [1, RANGE]},
        {"dags.count": [1, 3]},
        {"scheduler": ["heft", "cpop", "round_robin"]},
        {"interference": ["none", "csma_bianchi"]},
        {"routing": ["minimum_hop", "widest_path"]},
    ],
    ids=lambda vary: next(iter(vary)),
)
def test_workload_and_policies_leave_network_and_shadowing_alone(vary):
    for same_seed in scenarios(vary).values():
        assert len({each.network for each in same_seed}) == 1
        assert len({shadowed(each) for each in same_seed}) == 1


@pytest.mark.parametrize(
    "vary",
    [
        {"network.nodes": [4, 6, 9]},
        {"network.capacities": [100, RANGE]},
        {"rf.shadow_fading_sigma": [0, 6]},
        {"scheduler": ["heft", "cpop", "round_robin"]},
    ],
    ids=lambda vary: next(iter(vary)),
)
def test_network_radio_and_policies_leave_the_workload_alone(vary):
    for same_seed in scenarios(vary).values():
        first = same_seed[0].injections
        assert all(each.injections == first for each in same_seed)


def test_payloads_leave_costs_and_form_alone():
    for one, other in scenarios({"dags.payload_MB": [5, {"low": 1, "high": 9}]}).values():
        assert one.injections[0].dag.tasks == other.injections[0].dag.tasks
        assert one.injections[0].dag.dependencies != other.injections[0].dag.dependencies


def test_capacities_and_shadowing_leave_positions_alone():
    vary = {"network.capacities": [100, RANGE], "rf.shadow_fading_sigma": [0, 6]}
    for same_seed in scenarios(vary).values():
        places = {tuple(node.position for node in each.network.nodes) for each in same_seed}
        assert len(places) == 1


def test_seeds_differ_in_everything_that_is_drawn():
    (one,), (other,) = scenarios({}).values()

    assert one.network.nodes[0].position != other.network.nodes[0].position
    assert one.network.nodes[0].compute_capacity != other.network.nodes[0].compute_capacity
    assert one.injections != other.injections
    assert shadowed(one) != shadowed(other)


def test_shadowing_is_drawn_by_the_seed_on_a_network_that_is_not_drawn():
    plan = load_sweep(
        {
            "sweep": {
                "base": {
                    "network": {"type": "grid", "rows": 2, "columns": 3},
                    "dags": {"type": "chain", "tasks": 2},
                    "config": {"link_model": "wifi", "rf": {"shadow_fading_sigma": 6}},
                },
                "replicate": {"seeds": 3},
            }
        }
    )
    resolver = Resolver(plan)

    assert len({shadowed(resolver.scenario(run)) for run in plan.runs()}) == 3
