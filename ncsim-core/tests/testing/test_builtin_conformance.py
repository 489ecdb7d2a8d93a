"""Every built-in component keeps its contract."""

from ncsim_core.testing import (
    DAGSourceSuite,
    InterferenceModelSuite,
    LinkModelSuite,
    PluginSuite,
    QueueModelSuite,
    RoutingModelSuite,
    SchedulerSuite,
)


class TestCore(PluginSuite):
    distribution = "ncsim-core"


class TestManual(SchedulerSuite):
    component = "manual"


class TestRoundRobin(SchedulerSuite):
    component = "round_robin"


class TestAllOnFastest(SchedulerSuite):
    component = "all_on_fastest"


class TestDirect(RoutingModelSuite):
    component = "direct"


class TestStatic(LinkModelSuite):
    component = "static"


class TestNone(InterferenceModelSuite):
    component = "none"


class TestFifo(QueueModelSuite):
    component = "fifo"


class TestSingle(DAGSourceSuite):
    component = "single"


class TestMulti(DAGSourceSuite):
    component = "multi"
