import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.network import Network
from ncsim_core.testing.builders import line, make_context, node
from ncsim_wifi.interference_models.proximity import ProximityModel
from ncsim_wifi.validation.scenes import parallel


def factors(separation_m, active, **options):
    model = ProximityModel(make_context(parallel(4, separation_m).network()), **options)
    return model.factors(active, active).tolist()


def test_links_within_the_radius_share_equally():
    assert factors(5.0, [0, 1, 2]) == [1 / 3, 1 / 3, 1 / 3]


def test_a_midpoint_on_the_circle_is_inside():
    assert factors(15.0, [0, 1]) == [0.5, 0.5]
    assert factors(15.001, [0, 1]) == [1.0, 1.0]


def test_only_active_links_count():
    assert factors(5.0, [2]) == [1.0]


def test_the_radius_is_an_option():
    assert factors(10.0, [0, 1, 2, 3], radius=10.0) == [1 / 2, 1 / 3, 1 / 3, 1 / 2]


def test_both_directions_of_a_link_share_whatever_the_radius():
    model = ProximityModel(make_context(line(2)), radius=0.0)

    assert model.factors([0, 1], [0, 1]).tolist() == [0.5, 0.5]
    assert [each.contenders for each in model.competition([0, 1], [0, 1])] == [1, 1]


def test_links_without_positions_are_named():
    with pytest.raises(ScenarioError, match=r"proximity.*'n0_n1'"):
        ProximityModel(make_context(Network((node(0), node(1)), line(2).links)))
