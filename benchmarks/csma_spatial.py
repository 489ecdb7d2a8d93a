"""How long csma_spatial takes, with arrays and compiled: ``python benchmarks/csma_spatial.py``."""

import os
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from statistics import median

import numpy as np
from ncsim_core.acceleration import may_compile
from ncsim_core.contracts.routing_model import RouteTable
from ncsim_core.generators.paper import paper_grid
from ncsim_core.network import Route
from ncsim_core.testing.builders import make_context, rated
from ncsim_core.testing.oracle import FewestHops
from ncsim_wifi.interference_models.csma_spatial import CsmaSpatialModel, csma_spatial
from ncsim_wifi.phy.mcs import read_table
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial import forms
from ncsim_wifi.spatial.plant import Plant
from ncsim_wifi.spatial.scene import scene_of
from ncsim_wifi.spatial.settings import Settings
from ncsim_wifi.spatial.solve import FixedPoint

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
    """Print median and least CPU time of active sets, of transfers and of whole runs."""
    both = {"arrays": forms.ARRAYS}
    if may_compile():
        both["compiled"] = forms.compiled_loops()
    for count, side_m in ((1, 100.0), (10, 200.0), (30, 400.0), (100, 700.0)):
        scene = scene_of(random_plant(count, side_m), range(count))
        for name, form in both.items():
            solve = partial(solved, scene.plant, count, form)
            print(f"{count:4d} active links in {side_m:.0f} m, {name}: {told(solve)}")
    for count in (4, 16):
        routes = grid_routes(count)
        name = "compiled" if may_compile() else "arrays"
        took = told(lambda routes=routes: fresh_model().route_rates(routes))
        print(f"{count:4d} transfers of 1 to 4 hops on a 5x5 grid, {name}: {took}")
    for scheduler in ("heft", "cpop", "round_robin"):
        for routing in ("widest_path", "minimum_hop"):
            took = ", ".join(f"{name} {run_s(scheduler, routing, name):.2f} s" for name in both)
            print(f"20 tasks on a 4x4 grid, {scheduler}, {routing}: {took}")


def solved(plant: Plant, count: int, form: type[FixedPoint]) -> FloatArray:
    """Return the goodputs of all links, worked out from nothing."""
    return form(scene_of(plant, range(count))).goodputs_MBps()


def told(solve: Callable[[], object]) -> str:
    """Return median and least CPU time in words, the first time apart."""
    solve()
    took_ms = cpu_ms(solve)
    return f"{median(took_ms):.1f} ms (least {min(took_ms):.1f})"


RUN = """
import sys, time
scheduler, routing, form = sys.argv[1:]
if form == "compiled":
    from ncsim_wifi.spatial.forms import compiled_loops
    compiled_loops()
from ncsim_core import simulate
from ncsim_core.generators.paper import paper_dag, paper_grid
from ncsim_core.scenario.making import make_scenario
config = {"scheduler": scheduler, "routing": routing, "interference": "csma_spatial"}
simulate(make_scenario("first", paper_grid(2), [paper_dag(10)], config))
began_s = time.process_time()
simulate(make_scenario("run", paper_grid(4), [paper_dag(20)], config))
print(time.process_time() - began_s)
"""


def run_s(scheduler: str, routing: str, form: str) -> float:
    """Return the CPU time of a run in a process of its own, after a small one.

    Compiled, numba has been started and what it keeps has been read before.
    """
    pure = "1" if form == "arrays" else "0"
    command = [sys.executable, "-c", RUN, scheduler, routing, form]
    environment = os.environ | {"NCSIM_PURE": pure}
    done = subprocess.run(command, env=environment, capture_output=True, check=True)
    return float(done.stdout)


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
