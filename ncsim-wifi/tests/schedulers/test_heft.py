import pytest
from ncsim_core.network import NodeId
from ncsim_core.testing.builders import chain, dag_of, fork_join
from ncsim_wifi.schedulers.heft import PlanningNetwork, earliest_gap_s, heft_plan, upward_ranks


def planning(capacities, s_per_MB=0.1, latency_s=0.0):
    nodes = range(len(capacities))
    return PlanningNetwork(
        [NodeId(f"n{i}") for i in nodes],
        capacities,
        [[0.0 if a == b else s_per_MB for b in nodes] for a in nodes],
        [[0.0 if a == b else latency_s for b in nodes] for a in nodes],
    )


def test_ranks_are_the_longest_mean_path_to_an_exit():
    ranks = upward_ranks(chain(3, cost=100.0, size_MB=10.0), planning([100.0, 50.0], 0.1, 0.5))

    assert ranks == pytest.approx({"T2": 1.5, "T1": 1.5 + 1.5 + 1.5, "T0": 7.5})


def test_a_chain_stays_on_the_fastest_node():
    plan = heft_plan(chain(4), planning([50.0, 200.0, 100.0]))

    assert set(plan.nodes.values()) == {"n1"}


def test_parallel_tasks_spread_when_transfers_are_cheap():
    plan = heft_plan(fork_join(2, size_MB=0.01), planning([100.0, 100.0]))

    assert {plan.nodes["T1"], plan.nodes["T2"]} == {"n0", "n1"}


def test_parallel_tasks_stay_together_when_transfers_are_dear():
    plan = heft_plan(fork_join(3, size_MB=100.0), planning([100.0, 100.0], s_per_MB=1.0))

    assert len(set(plan.nodes.values())) == 1


def test_a_pinned_task_goes_where_it_is_pinned():
    plan = heft_plan(chain(2, pins={1: 0}), planning([1.0, 100.0]))

    assert plan.nodes == {"T0": "n1", "T1": "n0"}


def test_free_data_and_cost_keep_inputs_before_what_needs_them():
    dag = dag_of([(2, 1), (1, 0)], tasks=3, cost=0.0, size_MB=0.0)

    assert set(heft_plan(dag, planning([1.0])).nodes) == {"T0", "T1", "T2"}


def test_a_short_task_is_inserted_into_a_gap():
    assert earliest_gap_s([(0.0, 1.0), (4.0, 5.0)], 0.0, 3.0) == 1.0
