"""Every component of this package keeps what its contract promises."""

from ncsim_core.testing import PluginSuite, RoutingModelSuite


class TestPlugin(PluginSuite):
    distribution = "ncsim-routing"


class TestWidestPath(RoutingModelSuite):
    component = "widest_path"


class TestMinimumHop(RoutingModelSuite):
    component = "minimum_hop"


class TestShortestPath(RoutingModelSuite):
    component = "shortest_path"
