"""What SAGA sees of a network (SPEC 21)."""

from ncsim_core.testing.builders import line, make_snapshot, scattered
from ncsim_saga.virtual_network import node_name, virtual_network


def test_a_pair_has_the_bottleneck_of_its_route():
    snapshot = make_snapshot(line(3, bandwidth_MBps=2.5))

    assert virtual_network(snapshot).speed_MBps[0] == (10_000.0, 2.5, 2.5)


def test_an_unreachable_pair_has_a_small_speed():
    assert virtual_network(make_snapshot(scattered(2))).speed_MBps == (
        (10_000.0, 0.001),
        (0.001, 10_000.0),
    )


def test_a_link_without_bandwidth_leaves_its_ends_unreachable():
    snapshot = make_snapshot(line(2, bandwidth_MBps=0.0))

    assert virtual_network(snapshot).speed_MBps[0][1] == 0.001


def test_it_is_worked_out_once_per_table_of_routes():
    snapshot = make_snapshot(line(3))

    assert virtual_network(snapshot) is virtual_network(snapshot)
    assert virtual_network(snapshot) is not virtual_network(make_snapshot(line(3)))


def test_names_follow_the_order_of_the_file():
    assert [node_name(index) for index in range(3)] == ["n0", "n1", "n2"]
