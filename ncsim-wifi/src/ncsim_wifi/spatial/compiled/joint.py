"""The joint chains of back-off stages, from what relations contribute to them.

Source: MODEL 3.9 and 3.10; see ``ncsim_wifi.spatial.joint``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.chains import SideRates
from ncsim_wifi.spatial.compiled.chains import joint_stages
from ncsim_wifi.spatial.compiled.state import State, station_means
from ncsim_wifi.spatial.compiled.tables import Air, Hidden
from ncsim_wifi.spatial.losses import HiddenLoss


@inlined
def learn_chains(hidden: Hidden, state: State, sides: SideRates) -> None:
    """Solve the chains anew, and write down P(b | a) of each relation that has one."""
    count = len(hidden.station_of_side) // 2
    joint = joint_stages(sides, count)
    for place in range(len(hidden.chain_of)):
        side = hidden.chain_of[place].two
        given, chain = state.given[place], joint[side % count]
        for a in range(STAGES):
            total = 0.0
            for b in range(STAGES):
                given[a, b] = chain[a, b] if side < count else chain[b, a]
                total = total + given[a, b]
            for b in range(STAGES):
                given[a, b] /= max(total, 1e-300)
    state.known[0] = len(hidden.chain_of)


@inlined
def sides_of(
    air: Air,
    hidden: Hidden,
    state: State,
    loss: HiddenLoss,
    cycle_us: FloatArray,
    success: tuple[FloatArray, FloatArray],
) -> SideRates:
    """Return the sides of the chains; links that are not hurt contribute s = 1.

    Args:
        air: Links and stations.
        hidden: Relations and chains.
        state: Shares of links in the attempts of their station.
        loss: What relations do.
        cycle_us: cyc_u(k) of each station.
        success: tot_l(a) of each link, and sbar_r(a) of each relation.
    """
    whole, parts = success
    count = len(hidden.station_of_side)
    sides = _unhurt(hidden, station_means(air.links, state, whole), cycle_us)
    hurt = np.zeros(count)
    for chain in hidden.chain_of:
        at, side = chain.one, chain.two
        link = hidden.relations[at].link
        weight = state.links[link].attempts
        hurt[side] += weight
        for k in range(STAGES):
            sides.survives[side, k] += weight * (loss.survives[at, k] - 1.0)
            sides.hit[side, k] += weight * loss.hit[at, k]
            sides.share[side, k] += weight * loss.share[at, k]
            sides.grows[side, k] += weight * loss.grows[at, k]
            rest = min(1.0, whole[link, k] / max(parts[at, k], 1e-12))
            sides.other[side, k] += weight * (rest - whole[link, k])
    for side in range(count):
        for k in range(STAGES):
            sides.share[side, k] /= hurt[side]
            sides.grows[side, k] /= hurt[side]
            sides.other[side, k] = min(max(sides.other[side, k], 0.0), 1.0)
    return sides


@inlined
def _unhurt(hidden: Hidden, means: FloatArray, cycle_us: FloatArray) -> SideRates:
    """Return sides to which no relation has contributed yet."""
    shape = len(hidden.station_of_side), STAGES
    other, cycles_us = np.empty(shape), np.empty(shape)
    for side in range(len(other)):
        other[side] = means[hidden.station_of_side[side]]
        cycles_us[side] = cycle_us[hidden.station_of_side[side]]
    zeros = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    return SideRates(np.ones(shape), zeros[0], zeros[1], other, cycles_us, zeros[2])
