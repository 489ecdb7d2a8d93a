"""DAG sources that break their contract."""

import itertools

from ncsim_core.builtin.dag_sources import MultiDAGSource


class InjectionsEnd(MultiDAGSource):
    def injections(self):
        return itertools.cycle(super().injections())


class TimesNeverDecrease(MultiDAGSource):
    def injections(self):
        return super().injections()[::-1]


class DagIdsAreUnique(MultiDAGSource):
    def injections(self):
        return [each for each in super().injections() for _ in range(2)]
