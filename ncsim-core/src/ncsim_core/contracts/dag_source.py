"""Which DAGs arrive, and when?"""

from abc import ABC, abstractmethod
from collections.abc import Iterable

from ncsim_core.workflow import Injection


class DAGSource(ABC):
    """Says which DAGs enter a run; built from the scenario's own DAGs and the seed."""

    @abstractmethod
    def injections(self) -> Iterable[Injection]:
        """Return the injections, times 0 or more and not decreasing, DAG ids unique.

        Finite, and equal every time it is asked.
        """
