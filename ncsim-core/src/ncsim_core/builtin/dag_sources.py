"""DAG sources that inject what the scenario file lists."""

from collections.abc import Iterable

from typing_extensions import override

from ncsim_core.context import BuildContext
from ncsim_core.contracts.dag_source import DAGSource
from ncsim_core.errors import ScenarioError
from ncsim_core.workflow import Injection


class MultiDAGSource(DAGSource):
    """Injects every DAG of the scenario at its ``inject_at``; equal times in file order."""

    def __init__(self, context: BuildContext) -> None:
        self._injections = tuple(sorted(context.injections, key=lambda each: each.at_us))

    @override
    def injections(self) -> Iterable[Injection]:
        return self._injections


class SingleDAGSource(MultiDAGSource):
    """Injects the scenario's only DAG, and refuses a scenario with any other number."""

    def __init__(self, context: BuildContext) -> None:
        if len(context.injections) != 1:
            raise ScenarioError(
                f"dag_source single needs exactly one DAG, the scenario has "
                f"{len(context.injections)}; use dag_source: multi"
            )
        super().__init__(context)
