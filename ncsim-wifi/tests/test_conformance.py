"""Every component of this package keeps what its contract promises."""

from typing import ClassVar

from ncsim_core.testing import InterferenceModelSuite, LinkModelSuite, PluginSuite, SchedulerSuite


class TestPlugin(PluginSuite):
    distribution = "ncsim-wifi"


class TestWifi(LinkModelSuite):
    component = "wifi"


class TestCsmaBianchi(InterferenceModelSuite):
    component = "csma_bianchi"


class TestCsmaBianchiWithFloor(InterferenceModelSuite):
    component = "csma_bianchi"
    options: ClassVar = {"outage_floor_factor": 0.01}


class TestProximity(InterferenceModelSuite):
    component = "proximity"


class TestCsmaClique(InterferenceModelSuite):
    component = "csma_clique"


class TestConflictAwareHeft(SchedulerSuite):
    component = "conflict_aware_heft"


class TestUniformDiscountHeft(SchedulerSuite):
    component = "uniform_discount_heft"
