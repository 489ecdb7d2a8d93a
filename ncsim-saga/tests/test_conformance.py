"""Every component of this package keeps what its contract promises."""

from typing import ClassVar

from ncsim_core.errors import PlacementError
from ncsim_core.testing import PluginSuite, SchedulerSuite
from ncsim_core.testing.builders import make_context, make_snapshot, rated
from ncsim_core.testing.checking import check
from ncsim_saga.catalogue import SCHEDULERS
from ncsim_saga.schedulers.saga_scheduler import SagaScheduler


class Saga:
    """Draws fewer examples, and leaves hash seeds to ``test_hash_seeds``.

    That asks all schedulers in one process per seed; here each would wait for its own import of
    SAGA.
    """

    examples = 5

    @check(is_drawn=False)
    def check_hash_seed_changes_nothing(self, subject):
        """See ``test_hash_seeds``."""
        assert subject.component.name in SCHEDULERS


def keeps_all_tasks(case):
    """Return whether HBMCT plans all of a DAG."""
    network = case.network if case.network.rates else rated(case.network)
    try:
        SagaScheduler(make_context(network), name="hbmct").schedule(
            case.dag, make_snapshot(network)
        )
    except PlacementError:
        return False
    return True


class TestPlugin(PluginSuite):
    distribution = "ncsim-saga"


class TestHeft(SchedulerSuite):
    component = "heft"


class TestCpop(SchedulerSuite):
    component = "cpop"


class TestBil(Saga, SchedulerSuite):
    component = "bil"


class TestDps(Saga, SchedulerSuite):
    component = "dps"


class TestDuplex(Saga, SchedulerSuite):
    component = "duplex"


class TestEtf(Saga, SchedulerSuite):
    component = "etf"


class TestFastestNode(Saga, SchedulerSuite):
    component = "fastest_node"


class TestFcp(Saga, SchedulerSuite):
    component = "fcp"


class TestFlb(Saga, SchedulerSuite):
    component = "flb"


class TestGdl(Saga, SchedulerSuite):
    component = "gdl"


class TestHbmct(Saga, SchedulerSuite):
    """On DAGs of which it loses no task; elsewhere it has to say so, see ``test_planning``."""

    component = "hbmct"

    def cases(self):
        return super().cases().filter(keeps_all_tasks)


class TestMaxmin(Saga, SchedulerSuite):
    component = "maxmin"


class TestMct(Saga, SchedulerSuite):
    component = "mct"


class TestMet(Saga, SchedulerSuite):
    component = "met"


class TestMinmin(Saga, SchedulerSuite):
    component = "minmin"


class TestMsbc(Saga, SchedulerSuite):
    component = "msbc"


class TestMst(Saga, SchedulerSuite):
    component = "mst"


class TestOlb(Saga, SchedulerSuite):
    component = "olb"


class TestSufferage(Saga, SchedulerSuite):
    component = "sufferage"


class TestWba(Saga, SchedulerSuite):
    component = "wba"


class TestBruteForce(Saga, SchedulerSuite):
    component = "brute_force"
    max_nodes = 2
    max_tasks = 3


class TestSmt(Saga, SchedulerSuite):
    component = "smt"
    options: ClassVar = {}  # whatever solver is installed
    examples = 2
    max_nodes = 2
    max_tasks = 2
