import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.network import Network
from ncsim_core.testing.builders import chain, grid, line, make_context, make_snapshot, node
from ncsim_wifi.conflict import relations
from ncsim_wifi.radio import Radio
from ncsim_wifi.schedulers.airtime import (
    conflict_discounts,
    static_airtimes,
    uniform_discounts,
    usable_routes,
)
from ncsim_wifi.schedulers.discounted_heft import DiscountedHeftScheduler


def test_airtime_is_the_part_of_routes_that_use_a_link():
    network = line(3)
    routes = usable_routes(make_snapshot(network))

    airtimes = dict(zip([each.id for each in network.links], static_airtimes(routes, network),
                        strict=True))  # fmt: skip

    assert len(routes) == 6
    assert airtimes == pytest.approx(dict.fromkeys(airtimes, 2 / 6))


def test_a_fast_link_behind_a_slow_one_sends_less_of_the_time():
    network = line(2)

    airtimes = static_airtimes([(0, 1)], network.with_rates(
        type(network.rates)((10.0, 2.5), (0.0, 0.0))))  # fmt: skip

    assert airtimes == [0.25, 1.0]


def test_links_far_from_everybody_are_discounted_least():
    network = line(6, spacing_m=60.0)
    context = make_context(network)
    airtimes = static_airtimes(usable_routes(make_snapshot(network)), network)

    discounts = conflict_discounts(airtimes, relations(context, Radio()))

    assert discounts[0] > discounts[len(discounts) // 2]
    assert all(0.0 < each <= 1.0 for each in discounts)


def test_the_uniform_discount_is_the_mean():
    assert uniform_discounts([0.25, 0.75]) == [0.5, 0.5]
    assert uniform_discounts([]) == []


@pytest.mark.parametrize("discount", ["conflict_aware", "uniform"])
def test_plans_are_total(discount):
    network = grid(3, 3)

    plan = DiscountedHeftScheduler(make_context(network), discount=discount).schedule(
        chain(5), make_snapshot(network)
    )

    assert len(plan.nodes) == 5


def test_the_two_discounts_can_plan_differently():
    network = line(6, spacing_m=60.0, capacities=(100.0, 150.0, 300.0))
    snapshot, context = make_snapshot(network), make_context(network)

    aware, uniform = (
        DiscountedHeftScheduler(context, discount=each).discounts(snapshot)
        for each in ("conflict_aware", "uniform")
    )

    assert len(set(uniform)) == 1 < len(set(aware))
    assert sum(aware) == pytest.approx(sum(uniform))


def test_positions_are_needed():
    bare = Network((node(0), node(1)), line(2).links)

    with pytest.raises(ScenarioError, match=r"conflict_aware HEFT.*'n0_n1'"):
        DiscountedHeftScheduler(make_context(bare), discount="conflict_aware")
