"""What the radio model costs before a run and per refresh.

    python benchmarks/wifi_precomputation.py

Each size is built in a process of its own, so that the peak of its memory is its own. CPU seconds.
"""

import random
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from typing import TypeVar

from ncsim_core.context import BuildContext, ModelCache
from ncsim_core.contracts.interference_model import InterferenceSession
from ncsim_core.engine.sessions.choice import session_for
from ncsim_core.network import Link, LinkId, Network, Node, NodeId, Position

T = TypeVar("T")

SPACING_m = 40  # of the paper's grids
CROWDED_m = 10  # at which almost every link affects every other
SIZES = ((20, 20, SPACING_m), (40, 50, SPACING_m), (40, 50, CROWDED_m))
TRAFFIC = ((4, 4, 8, 2), (20, 20, 40, 5), (20, 20, 200, 13), (40, 50, 200, 13))
REFRESHES = 1000


def grid(rows: int, columns: int, spacing_m: float = SPACING_m) -> Network:
    """Return a grid whose neighbours are linked both ways."""
    places = [(row, column) for row in range(rows) for column in range(columns)]
    nodes = tuple(
        Node(NodeId(f"n{i}"), 100.0, Position(spacing_m * column, spacing_m * row))
        for i, (row, column) in enumerate(places)
    )
    right = [(i, i + 1) for i, (_, column) in enumerate(places) if column + 1 < columns]
    below = [(i, i + columns) for i, (row, _) in enumerate(places) if row + 1 < rows]
    ends = [pair for a, b in sorted(right + below) for pair in ((a, b), (b, a))]
    links = tuple(Link(LinkId(f"l{a}_{b}"), nodes[a].id, nodes[b].id) for a, b in ends)
    return Network(nodes, links)


def timed(name: str, work: Callable[[], T]) -> T:
    """Return the result of some work after printing what it took."""
    start = time.process_time()
    result = work()
    print(f"  {name:38} {time.process_time() - start:8.3f} s")
    return result


def build(rows: int, columns: int, spacing_m: int) -> None:
    """Print what it takes to prepare a network."""
    from ncsim_wifi.conflict import relations
    from ncsim_wifi.interference_models.csma_bianchi import csma_bianchi
    from ncsim_wifi.link_models.wifi import WifiLinkModel
    from ncsim_wifi.propagation import propagation
    from ncsim_wifi.radio import Radio

    network = grid(rows, columns, spacing_m)
    print(f"{len(network.nodes)} nodes {spacing_m} m apart, {len(network.links)} links")
    context = BuildContext(network, cache=ModelCache())
    before_MB, start = _peak_MB(), time.process_time()
    timed("power matrix", lambda: propagation(context, Radio()))
    timed("link rates", lambda: WifiLinkModel(context).rate_links(network))
    related = timed("conflict graph and hidden powers", lambda: relations(context, Radio()))
    model = timed("thresholds of all links", lambda: csma_bianchi(context))
    tables = timed("tables", model.tables)
    timed("session", lambda: session_for(model, tables))
    print(f"  {'together':38} {time.process_time() - start:8.3f} s")
    timed("the same again, from the cache", lambda: csma_bianchi(context).tables())
    print(f"  {'memory added':38} {_peak_MB() - before_MB:8.0f} MB")
    print(
        f"  {'links affected by one, on average':38} {len(related.links) / related.link_count:8.0f}"
    )


def refresh(rows: int, columns: int, transfers: int, hops: int) -> None:
    """Print what one start or finish of a transfer costs the model."""
    from ncsim_wifi.interference_models.csma_bianchi import csma_bianchi

    network = grid(rows, columns)
    model = csma_bianchi(BuildContext(network, cache=ModelCache()))
    session = session_for(model, model.tables())
    traffic = Traffic(network, session, hops)
    for _ in range(transfers):
        traffic.start()
    spent, changed = 0.0, 0
    for _ in range(REFRESHES // 2):
        for step in (traffic.stop, traffic.start):
            seconds, count = step()
            spent, changed = spent + seconds, changed + count
    print(
        f"{len(network.links):6} links, {transfers:4} transfers of about {hops:2} hops: "
        f"{spent / REFRESHES * 1e6:7.1f} us per refresh, {changed / REFRESHES:5.1f} factors changed"
    )


class Traffic:
    """Transfers on random walks that start and stop."""

    def __init__(self, network: Network, session: InterferenceSession, hops: int) -> None:
        self._network = network
        self._session = session
        self._hops = hops
        self._draw = random.Random(1)
        self._users = [0] * len(network.links)
        self._routes: list[list[int]] = []

    def start(self) -> tuple[float, int]:
        """Start a transfer; return CPU seconds and the number of changed factors."""
        route = self._route()
        self._routes.append(route)
        on = [link for link in route if self._users[link] == 0]
        for link in route:
            self._users[link] += 1
        return self._timed_update(on, [])

    def stop(self) -> tuple[float, int]:
        """Stop a random transfer; return CPU seconds and the number of changed factors."""
        route = self._routes.pop(self._draw.randrange(len(self._routes)))
        for link in route:
            self._users[link] -= 1
        return self._timed_update([], [link for link in route if self._users[link] == 0])

    def _timed_update(self, on: list[int], off: list[int]) -> tuple[float, int]:
        start = time.process_time()
        changed, _ = self._session.update(on, off)
        return time.process_time() - start, len(changed)

    def _route(self) -> list[int]:
        at = self._draw.randrange(len(self._network.nodes))
        seen, route = {at}, []
        for _ in range(self._hops):
            leaving = [
                link
                for link in self._network.outgoing[at]
                if self._network.targets[link] not in seen
            ]
            if not leaving:
                break
            link = self._draw.choice(leaving)
            at = self._network.targets[link]
            seen.add(at)
            route.append(link)
        return route


def _peak_MB() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def main() -> None:
    """Run every measurement in a process of its own."""
    if len(sys.argv) > 1:
        name, *numbers = sys.argv[1:]
        {"build": build, "refresh": refresh}[name](*map(int, numbers))
        return
    for size in SIZES:
        _in_new_process("build", size)
    for setting in TRAFFIC:
        _in_new_process("refresh", setting)


def _in_new_process(name: str, numbers: tuple[int, ...]) -> None:
    subprocess.run([sys.executable, __file__, name, *map(str, numbers)], check=True)


if __name__ == "__main__":
    main()
