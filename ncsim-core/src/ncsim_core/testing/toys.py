"""Small components for tests of the engine: plain, deterministic, with every hard case."""

from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

from typing_extensions import override

from ncsim_core.builtin.dag_sources import MultiDAGSource
from ncsim_core.builtin.interference_models import NoInterference
from ncsim_core.builtin.link_models import StaticLinkModel
from ncsim_core.builtin.queue_models import FifoQueue
from ncsim_core.builtin.schedulers import RoundRobinScheduler
from ncsim_core.contracts.interference_model import Competition, InterferenceModel
from ncsim_core.contracts.queue_model import QueueModel
from ncsim_core.contracts.routing_model import RoutingModel
from ncsim_core.contracts.scheduler import Scheduler
from ncsim_core.models import Models
from ncsim_core.network import LinkIndex, Network
from ncsim_core.testing.builders import make_context
from ncsim_core.testing.oracle import FewestHops
from ncsim_core.workflow import Injection

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class ToyRadio(InterferenceModel):
    """Contention divides by the active neighbours; each hidden interferer takes a quarter.

    Args:
        neighbours: By link, the links it shares the channel with.
        hidden: By link, the links that disturb its receiver unheard.
        stop_at: Number of active neighbours from which the factor is 0.
    """

    def __init__(
        self,
        neighbours: Mapping[LinkIndex, Collection[LinkIndex]],
        hidden: Mapping[LinkIndex, Collection[LinkIndex]] = MappingProxyType({}),
        *,
        stop_at: int = 99,
    ) -> None:
        self._neighbours = neighbours
        self._hidden = hidden
        self._stop_at = stop_at

    @override
    def factors(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> "NDArray[np.float64]":
        import numpy as np

        against = self.competition(links, active)
        return np.array([self._contention(each) * each.hidden_factor for each in against])

    def _contention(self, against: Competition) -> float:
        return 0.0 if against.contenders >= self._stop_at else 1.0 / (1 + against.contenders)

    @override
    def reach(self, changed: Collection[LinkIndex]) -> Collection[LinkIndex]:
        tables = (self._neighbours, self._hidden)
        near = {link for table in tables for link in table if set(table[link]) & set(changed)}
        return near | set(changed)

    @override
    def competition(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> Sequence[Competition]:
        return [self._against(link, set(active) - {link}) for link in links]

    def _against(self, link: LinkIndex, others: set[LinkIndex]) -> Competition:
        contenders = others.intersection(self._neighbours.get(link, ()))
        hidden = others.intersection(self._hidden.get(link, ())) - contenders
        return Competition(len(contenders), len(hidden), 0.75 ** len(hidden))


def models(
    network: Network,
    injections: Sequence[Injection],
    *,
    scheduler: Scheduler | None = None,
    routing: RoutingModel | None = None,
    interference: InterferenceModel | None = None,
    queue: type[QueueModel] = FifoQueue,
) -> Models:
    """Return six components for a run on ``network``; the plainest where none is given."""
    context = make_context(network, injections=injections)
    return Models(
        scheduler=scheduler or RoundRobinScheduler(context),
        routing=routing or FewestHops(),
        link_model=StaticLinkModel(context),
        interference=interference or NoInterference(context),
        new_queue=lambda: queue(context),  # type: ignore[call-arg]
        dag_source=MultiDAGSource(context),
    )
