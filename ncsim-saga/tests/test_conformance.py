"""Every component of this package keeps what its contract promises."""

from typing import ClassVar

from ncsim_core.errors import PlacementError
from ncsim_core.testing import PluginSuite, SchedulerSuite
from ncsim_core.testing.builders import make_context, make_snapshot, rated
from ncsim_core.testing.checking import check
from ncsim_saga.catalogue import SCHEDULERS
from ncsim_saga.schedulers.saga_scheduler import SagaScheduler


class SagaSuite(SchedulerSuite):
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


class TestBil(SagaSuite):
    component = "bil"


class TestDps(SagaSuite):
    component = "dps"


class TestDuplex(SagaSuite):
    component = "duplex"


class TestEtf(SagaSuite):
    component = "etf"


class TestFastestNode(SagaSuite):
    component = "fastest_node"


class TestFcp(SagaSuite):
    component = "fcp"


class TestFlb(SagaSuite):
    component = "flb"


class TestGdl(SagaSuite):
    component = "gdl"


class TestHbmct(SagaSuite):
    """On DAGs of which it loses no task; elsewhere it has to say so, see ``test_planning``."""

    component = "hbmct"

    def cases(self):
        return super().cases().filter(keeps_all_tasks)


class TestMaxmin(SagaSuite):
    component = "maxmin"


class TestMct(SagaSuite):
    component = "mct"


class TestMet(SagaSuite):
    component = "met"


class TestMinmin(SagaSuite):
    component = "minmin"


class TestMsbc(SagaSuite):
    component = "msbc"


class TestMst(SagaSuite):
    component = "mst"


class TestOlb(SagaSuite):
    component = "olb"


class TestSufferage(SagaSuite):
    component = "sufferage"


class TestWba(SagaSuite):
    component = "wba"


class TestBruteForce(SagaSuite):
    component = "brute_force"
    max_nodes = 2
    max_tasks = 3


class TestSmt(SagaSuite):
    component = "smt"
    expected_failures: ClassVar = {
        "extremes_are_planned": "SAGA's SMT finds no schedule at all when a DAG needs no time"
    }
    options: ClassVar = {}  # whatever solver is installed
    examples = 2
    max_nodes = 2
    max_tasks = 2
