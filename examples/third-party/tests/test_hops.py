from ncsim_core.testing.builders import chain, line, make_context, make_snapshot
from ncsim_lookahead.schedulers import Lookahead


def plan(hop_weight, *, size_MB):
    network = line(3, capacities=[10.0, 10.0, 15.0])
    scheduler = Lookahead(make_context(network), hop_weight)
    dag = chain(2, cost=100.0, size_MB=size_MB, pins={0: 0})
    return scheduler.schedule(dag, make_snapshot(network)).nodes["T1"]


def test_a_faster_node_two_hops_away_is_worth_it_only_if_hops_are_cheap():
    assert plan(0.0, size_MB=30.0) == "n2"
    assert plan(1.0, size_MB=30.0) == "n0"


def test_small_data_may_travel():
    assert plan(1.0, size_MB=1.0) == "n2"
