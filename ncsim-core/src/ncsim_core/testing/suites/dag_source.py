"""Properties of DAG sources."""

import itertools
from typing import cast

from hypothesis.strategies import SearchStrategy
from typing_extensions import override

from ncsim_core.contracts.dag_source import DAGSource
from ncsim_core.testing import strategies
from ncsim_core.testing.checking import check
from ncsim_core.testing.questions import Case
from ncsim_core.testing.subject import Subject
from ncsim_core.testing.suites.base import ComponentSuite
from ncsim_core.workflow import Injection

MANY_INJECTIONS = 100_000


class DAGSourceSuite(ComponentSuite):
    """Checks of a DAG source. That DAGs have no cycle is seen to by ``DAG`` itself."""

    kind = "dag_source"

    @override
    def cases(self) -> SearchStrategy[Case]:
        return strategies.arrivals()

    @check()
    def check_injections_end(self, subject: Subject, case: Case) -> None:
        """The stream is finite and holds injections only."""
        injections = _injections(subject, case)
        assert len(injections) < MANY_INJECTIONS, f"more than {MANY_INJECTIONS} injections"
        for each in injections:
            assert isinstance(each, Injection), f"{each!r} is no Injection"

    @check()
    def check_times_never_decrease(self, subject: Subject, case: Case) -> None:
        """Times are whole microseconds, 0 or more, and never decrease."""
        times = [each.at_us for each in _injections(subject, case)]
        assert all(type(each) is int and each >= 0 for each in times), f"times {times}"
        assert times == sorted(times), f"times {times}"

    @check()
    def check_dag_ids_are_unique(self, subject: Subject, case: Case) -> None:
        """No two DAGs share an id."""
        ids = [each.dag.id for each in _injections(subject, case)]
        assert len(ids) == len(set(ids)), f"ids {ids}"


def _injections(subject: Subject, case: Case) -> list[Injection]:
    source = cast("DAGSource", subject.build(case))
    return list(itertools.islice(source.injections(), MANY_INJECTIONS))
