"""What one transfer over several hops gets: its relays forward no more than they receive.

Source: MODEL 5, the clique rule.
"""

from collections.abc import Sequence

import numpy as np

from ncsim_wifi.mac.efficiency import efficiency
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.quantities import BoolArray
from ncsim_wifi.spatial.plant import Plant
from ncsim_wifi.spatial.scene import Scene

KILL_IN_CONFLICT = 0.5
REFERENCE_RATE_Mbps = 68.8  # the loss of efficiency hardly depends on it


def hop_conflicts(plant: Plant, hops: Sequence[int]) -> BoolArray:
    """Return which hops of a route cannot succeed together, shape (hops, hops).

    Source: MODEL 5: same transmitter, sensing, or a loss above one half at either receiver.
    """
    from ncsim_wifi.spatial.hazard import hazard

    scene = Scene(plant, np.array(hops))
    every = np.arange(len(hops))
    ratio_dB = scene.ratio_dB(scene.at_receiver_mW.T + plant.noise_mW, every[:, None])
    lost = -np.expm1(-hazard(scene.scheme[:, None], ratio_dB)) > KILL_IN_CONFLICT
    hurts = (lost | (ratio_dB < plant.settings.preamble_ratio_dB))[:, scene.station]
    shares = scene.station[:, None] == scene.station[None, :]
    senses = scene.senses[np.ix_(scene.station, scene.station)]
    return np.asarray(hurts | hurts.T | shares | senses)


def clique_efficiency(size: int, *, rts_cts: bool) -> float:
    """Return eff(n), what n contending hops achieve relative to one.

    Source: MODEL 5, after Eq. 8 (``eq:eta``).

    >>> clique_efficiency(1, rts_cts=False)
    1.0
    """
    timing = AxTiming(rts_cts)
    alone = efficiency(1, REFERENCE_RATE_Mbps, timing)
    return efficiency(size, REFERENCE_RATE_Mbps, timing) / alone


def clique_limits_MBps(
    plant: Plant, hops: Sequence[int], clean_MBps: Sequence[float]
) -> list[tuple[float, tuple[int, ...]]]:
    """Return what each clique of conflicting hops, which share their air, lets through.

    Source: MODEL 5.

    Args:
        plant: All links of the network.
        hops: The links of the route, in order.
        clean_MBps: What each delivers alone, greater than 0.

    Returns:
        For each maximal clique its limit and its members, as places in ``hops``.
    """
    if not hops:
        return []
    return [
        (
            clique_efficiency(len(clique), rts_cts=plant.settings.rts_cts)
            / sum(1.0 / clean_MBps[hop] for hop in sorted(clique)),
            clique,
        )
        for clique in maximal_cliques(hop_conflicts(plant, hops))
    ]


def maximal_cliques(related: BoolArray) -> list[tuple[int, ...]]:
    """Return the maximal cliques of a small symmetric relation (Bron and Kerbosch, 1973)."""
    neighbours = [set(np.flatnonzero(row).tolist()) - {at} for at, row in enumerate(related)]
    found: list[tuple[int, ...]] = []

    def extend(clique: tuple[int, ...], candidates: set[int], excluded: set[int]) -> None:
        if not candidates and not excluded:
            found.append(clique)
            return
        pivot = max(candidates | excluded, key=lambda at: (len(neighbours[at] & candidates), -at))
        for one in sorted(candidates - neighbours[pivot]):
            extend((*clique, one), candidates & neighbours[one], excluded & neighbours[one])
            candidates = candidates - {one}
            excluded = excluded | {one}

    extend((), set(range(len(neighbours))), set())
    return found
