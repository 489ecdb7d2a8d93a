"""How long csma_spatial takes per active set: ``python benchmarks/csma_spatial.py``."""

import time

import numpy as np
from ncsim_wifi.phy.mcs import read_table
from ncsim_wifi.spatial.plant import Plant
from ncsim_wifi.spatial.settings import Settings
from ncsim_wifi.spatial.solve import saturated_goodputs_MBps

REPEATS = 7
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


def main() -> None:
    """Print the best of several runs for each number of active links."""
    for count, side_m in ((1, 100.0), (10, 200.0), (30, 400.0), (100, 700.0)):
        plant = random_plant(count, side_m)
        took_s = []
        for _ in range(REPEATS):
            began_s = time.process_time()
            saturated_goodputs_MBps(plant, range(count))
            took_s.append(time.process_time() - began_s)
        print(f"{count:4d} active links in {side_m:.0f} m: {1e3 * min(took_s):.1f} ms")


if __name__ == "__main__":
    main()
