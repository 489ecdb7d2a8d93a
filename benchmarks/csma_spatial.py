"""How long csma_spatial takes per active set: ``python benchmarks/csma_spatial.py``."""

import time
from collections.abc import Callable
from functools import partial
from statistics import median

import numpy as np
from ncsim_core.contracts.routing_model import RouteTable
from ncsim_core.generators.paper import paper_grid
from ncsim_core.network import Route
from ncsim_core.testing.builders import make_context, rated
from ncsim_core.testing.oracle import FewestHops
from ncsim_wifi.interference_models.csma_spatial import CsmaSpatialModel, csma_spatial
from ncsim_wifi.phy.mcs import read_table
from ncsim_wifi.spatial.plant import Plant
from ncsim_wifi.spatial.settings import Settings
from ncsim_wifi.spatial.solve import saturated_goodputs_MBps

REPEATS = 7
SIZE = 5
MCS = 5


def random_plant(count: int, side_m: float) -> Plant:
    """Return ``count`` links of 30 m with random senders in a square."""
    rng = np.random.default_rng(count)
    senders_m = rng.uniform(0.0, side_m, (count, 2))
    turned = rng.uniform(0.0, 2 * np.pi, count)
    receivers_m = senders_m + 30.0 * np.stack([np.cos(turned), np.sin(turned)], axis=1)
    at_m = np.concatenate([senders_m, receivers_m])
    apart_m = np.hypot(*(at_m[:, None] - at_m[None]).transpose(2, 0, 1))
    return Plant(
        tuple(f"l{link}" for link in range(count)),
        np.arange(count),
        np.arange(count) + count,
        np.full(count, MCS),
        np.full(count, read_table("ax").rate_Mbps[MCS]),
        20.0 - 46.42 - 30.0 * np.log10(np.maximum(apart_m, 1.0)),
        Settings(),
    )


def cpu_ms(solve: Callable[[], object]) -> list[float]:
    """Return the CPU time of several runs."""
    took_ms = []
    for _ in range(REPEATS):
        began_s = time.process_time()
        solve()
        took_ms.append(1e3 * (time.process_time() - began_s))
    return took_ms


def main() -> None:
    """Print median and least CPU time for each number of active links, and of transfers."""
    for count, side_m in ((1, 100.0), (10, 200.0), (30, 400.0), (100, 700.0)):
        plant = random_plant(count, side_m)
        took_ms = cpu_ms(partial(saturated_goodputs_MBps, plant, range(count)))
        print(
            f"{count:4d} active links in {side_m:.0f} m: "
            f"{median(took_ms):.1f} ms (least {min(took_ms):.1f})"
        )
    for count in (4, 16):
        routes = grid_routes(count)
        took_ms = cpu_ms(lambda routes=routes: fresh_model().route_rates(routes))
        print(
            f"{count:4d} transfers of 1 to 4 hops on a 5x5 grid: "
            f"{median(took_ms):.1f} ms (least {min(took_ms):.1f})"
        )


def fresh_model() -> CsmaSpatialModel:
    """Return a model that has solved nothing yet."""
    return csma_spatial(make_context(rated(paper_grid(SIZE))))


def grid_routes(count: int) -> list[Route]:
    """Return routes between random nodes of the grid, along fewest hops."""
    network = rated(paper_grid(SIZE))
    routes = RouteTable(FewestHops(), network)
    rng = np.random.default_rng(count)
    found: list[Route] = []
    while len(found) < count:
        source, target = rng.choice(SIZE * SIZE, 2, replace=False).tolist()
        if route := routes.route(source, target):
            found.append(route)
    return sorted(found)


if __name__ == "__main__":
    main()
