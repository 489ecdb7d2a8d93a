"""Small components for tests of the engine: plain, deterministic, with every hard case."""

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING

from typing_extensions import override

from ncsim_core.builtin.dag_sources import MultiDAGSource
from ncsim_core.builtin.interference_models import NoInterference
from ncsim_core.builtin.link_models import StaticLinkModel
from ncsim_core.builtin.queue_models import FifoQueue
from ncsim_core.builtin.schedulers import RoundRobinScheduler
from ncsim_core.contracts.interference_model import Competition, InterferenceModel, RouteRates
from ncsim_core.contracts.interference_tables import InterferenceTables, ShareRow
from ncsim_core.contracts.queue_model import QueueModel
from ncsim_core.contracts.routing_model import RoutingModel
from ncsim_core.contracts.scheduler import Scheduler
from ncsim_core.models import Models
from ncsim_core.network import LinkIndex, Network, Route
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


class TabledRadio(ToyRadio):
    """The same as data, for the engine's own sessions and its compiled loop.

    Args:
        link_count: Links of the network.
        neighbours: As of a ``ToyRadio``; a link named among its own is not counted.
        hidden: Likewise.
        stop_at: Likewise.
    """

    def __init__(
        self,
        link_count: int,
        neighbours: Mapping[LinkIndex, Collection[LinkIndex]],
        hidden: Mapping[LinkIndex, Collection[LinkIndex]] = MappingProxyType({}),
        *,
        stop_at: int = 99,
    ) -> None:
        super().__init__(neighbours, hidden, stop_at=stop_at)
        self._tables = self._made(link_count)

    @override
    def tables(self) -> InterferenceTables:
        return self._tables

    def _made(self, link_count: int) -> InterferenceTables:
        import numpy as np

        pairs = []
        for link in range(link_count):
            near = set(self._neighbours.get(link, ())) - {link}
            far = set(self._hidden.get(link, ())) - near - {link}
            pairs += [(by, link, by in near) for by in near | far]
        pairs.sort()
        levels = [len(set(self._hidden.get(link, ()))) + 1 for link in range(link_count)]
        rows = [ShareRow(partial(self._share, hidden)) for hidden in range(max(levels))]
        return InterferenceTables(
            starts=np.searchsorted([by for by, _, _ in pairs], np.arange(link_count + 1)),
            links=np.array([link for _, link, _ in pairs], np.int32),
            is_conflict=np.array([is_near for _, _, is_near in pairs], np.bool_),
            hidden_units=np.ones(len(pairs), np.int64),
            limits=[tuple(range(count - 1)) for count in levels],
            shares=[rows[:count] for count in levels],
            hidden_factors=[[0.75**hidden for hidden in range(count)] for count in levels],
        )

    def _share(self, hidden: int, stations: int) -> float:
        against = Competition(stations - 1, hidden, 0.75**hidden)
        return self._contention(against) * against.hidden_factor


class ToyRelays(InterferenceModel):
    """Max-min fair rates of whole routes; relaying halves what a route can get.

    Args:
        network: A network whose rates are decided.
        stop_at: Number of transfers on one link from which all transfers stop.
    """

    decides_routes = True

    def __init__(self, network: Network, *, stop_at: int = 99) -> None:
        self._bandwidth_MBps = network.bandwidth_MBps
        self._stop_at = stop_at

    @override
    def factors(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> "NDArray[np.float64]":
        import numpy as np

        return np.ones(len(links))

    @override
    def reach(self, changed: Collection[LinkIndex]) -> Collection[LinkIndex]:
        return changed

    @override
    def route_rates(self, routes: Sequence[Route]) -> RouteRates:
        import numpy as np

        on_link = Counter(link for route in routes for link in route)
        left_MBps = {link: self._bandwidth_MBps[link] for link in on_link}
        waiting = sorted(range(len(routes)), key=routes.__getitem__)
        rates_MBps, bottlenecks = np.zeros(len(routes)), [-1] * len(routes)
        while waiting:  # the route that can get least goes first, and keeps what it gets
            offers = [self._offer(routes[k], left_MBps, on_link) for k in waiting]
            (rate_MBps, link), number = min(zip(offers, waiting, strict=True))
            waiting.remove(number)
            rates_MBps[number], bottlenecks[number] = rate_MBps, link
            for each in routes[number]:
                left_MBps[each] -= rate_MBps
                on_link[each] -= 1
        if self._is_stopped(routes):
            rates_MBps[:] = 0.0
        return RouteRates(rates_MBps, bottlenecks)

    def _offer(
        self, route: Route, left_MBps: Mapping[LinkIndex, float], on_link: Mapping[LinkIndex, int]
    ) -> tuple[float, LinkIndex]:
        """Return the most that a route can get now, and the link that sets it."""
        relays = min(2, len(route))
        return min(
            (min(left_MBps[link] / on_link[link], self._bandwidth_MBps[link] / relays), link)
            for link in route
        )

    def _is_stopped(self, routes: Sequence[Route]) -> bool:
        counts = Counter(link for route in routes for link in route)
        return max(counts.values(), default=0) >= self._stop_at


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
