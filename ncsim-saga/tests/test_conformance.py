"""Every component of this package keeps what its contract promises."""

from typing import ClassVar

from ncsim_core.testing import PluginSuite, SchedulerSuite


class TestPlugin(PluginSuite):
    distribution = "ncsim-saga"


class TestHeft(SchedulerSuite):
    component = "heft"


class TestCpop(SchedulerSuite):
    component = "cpop"


class TestBil(SchedulerSuite):
    component = "bil"
    examples = 5


class TestDps(SchedulerSuite):
    component = "dps"
    examples = 5


class TestDuplex(SchedulerSuite):
    component = "duplex"
    examples = 5


class TestEtf(SchedulerSuite):
    component = "etf"
    examples = 5


class TestFastestNode(SchedulerSuite):
    component = "fastest_node"
    examples = 5


class TestFcp(SchedulerSuite):
    component = "fcp"
    examples = 5


class TestFlb(SchedulerSuite):
    component = "flb"
    examples = 5


class TestGdl(SchedulerSuite):
    component = "gdl"
    examples = 5


class TestHbmct(SchedulerSuite):
    component = "hbmct"
    examples = 5


class TestMaxmin(SchedulerSuite):
    component = "maxmin"
    examples = 5


class TestMct(SchedulerSuite):
    component = "mct"
    examples = 5


class TestMet(SchedulerSuite):
    component = "met"
    examples = 5


class TestMinmin(SchedulerSuite):
    component = "minmin"
    examples = 5


class TestMsbc(SchedulerSuite):
    component = "msbc"
    examples = 5


class TestMst(SchedulerSuite):
    component = "mst"
    examples = 5


class TestOlb(SchedulerSuite):
    component = "olb"
    examples = 5


class TestSufferage(SchedulerSuite):
    component = "sufferage"
    examples = 5


class TestWba(SchedulerSuite):
    component = "wba"
    examples = 5


class TestBruteForce(SchedulerSuite):
    component = "brute_force"
    examples = 5
    max_nodes = 2
    max_tasks = 3


class TestSmt(SchedulerSuite):
    component = "smt"
    expected_failures: ClassVar = {
        "extremes_are_planned": "SAGA's SMT finds no schedule at all when a DAG needs no time"
    }
    options: ClassVar = {}  # whatever solver is installed
    examples = 2
    max_nodes = 2
    max_tasks = 2
