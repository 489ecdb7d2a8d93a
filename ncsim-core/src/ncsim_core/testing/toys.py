"""Small components for tests of the engine: plain, deterministic, with every hard case."""

from collections.abc import Collection, Mapping, Sequence
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


class ToyInterference(InterferenceModel):
    """Divides by the active neighbours, and stops a link that too many of them surround.

    Args:
        neighbours: By link, the links that slow it down.
        stop_at: Number of active neighbours from which the factor is 0.
    """

    def __init__(
        self, neighbours: Mapping[LinkIndex, Collection[LinkIndex]], stop_at: int = 99
    ) -> None:
        self._neighbours = {link: frozenset(others) for link, others in neighbours.items()}
        self._stop_at = stop_at

    @override
    def factors(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> "NDArray[np.float64]":
        import numpy as np

        counts = [len(self._active_neighbours(link, active)) for link in links]
        return np.array([0.0 if n >= self._stop_at else 1.0 / (1 + n) for n in counts])

    @override
    def reach(self, changed: Collection[LinkIndex]) -> Collection[LinkIndex]:
        near = {link for link, others in self._neighbours.items() if others & set(changed)}
        return near | set(changed)

    @override
    def competition(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> Sequence[Competition]:
        return [Competition(len(self._active_neighbours(link, active))) for link in links]

    def _active_neighbours(
        self, link: LinkIndex, active: Collection[LinkIndex]
    ) -> frozenset[LinkIndex]:
        return self._neighbours.get(link, frozenset()).intersection(active) - {link}


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
