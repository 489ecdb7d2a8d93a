"""The back-off stages of two stations that hurt each other, chain by chain.

Source: MODEL 3.10; see ``ncsim_wifi.spatial.chains``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.chains import BOUNDARY, SideRates
from ncsim_wifi.spatial.compiled.tables import Records

LAST = STAGES - 1
KINDS = 5
SUCCESS_A, SUCCESS_B, COMMON, LOSS_A, LOSS_B = range(KINDS)
SIDE_RATES = 6
SURVIVES, HIT, SHARE, OTHER, RATE, GROWS = range(SIDE_RATES)


@inlined
def joint_stages(both: SideRates, count: int) -> FloatArray:
    """Return the time-weighted distribution P(a, b) of each chain, shape (chains, 7, 7).

    Args:
        both: The first sides of all chains, then the second ones.
        count: Number of chains.
    """
    joint = np.empty((count, STAGES, STAGES))
    rates = np.empty((STAGES, STAGES, KINDS))
    spread = np.zeros((STAGES, STAGES, BOUNDARY))
    for stage in range(STAGES):
        spread[0, stage, stage] = 1.0
        spread[stage, 0, stage + STAGES - 1 if stage else 0] = 1.0
    flow = np.empty((BOUNDARY + 1, BOUNDARY))
    boundary = np.empty(BOUNDARY)
    sides = np.empty((2, SIDE_RATES, STAGES))
    for chain in range(count):
        _fill_side(both, chain, sides[0])
        _fill_side(both, count + chain, sides[1])
        _fill_rates(sides, rates)
        _fill_spread(rates, spread)
        _fill_flow(rates, spread, flow)
        _eliminate(flow, boundary)
        _weigh(spread, boundary, joint, chain)
    return joint


@inlined
def _fill_side(side: SideRates, chain: int, values: FloatArray) -> None:
    for stage in range(STAGES):
        values[SURVIVES, stage] = side.survives[chain, stage]
        values[HIT, stage] = max(side.hit[chain, stage], 1e-12)
        values[SHARE, stage] = side.share[chain, stage]
        values[OTHER, stage] = side.other[chain, stage]
        values[RATE, stage] = 1.0 / side.cycle_us[chain, stage]
        values[GROWS, stage] = side.grows[chain, stage]


@inlined
def _fill_rates(sides: FloatArray, rates: FloatArray) -> None:
    """Fill the rates out of all states of one chain; a, b are stages of the two sides."""
    for a in range(STAGES):
        for b in range(STAGES):
            rate_a, rate_b = sides[0, RATE, a], sides[1, RATE, b]
            survives_a = max(0.0, 1.0 - sides[0, GROWS, a] * (1.0 - sides[0, SURVIVES, b]))
            survives_b = max(0.0, 1.0 - sides[1, GROWS, b] * (1.0 - sides[1, SURVIVES, a]))
            hit_a, hit_b = sides[0, HIT, b], sides[1, HIT, a]
            success_a = survives_a * sides[0, OTHER, a] * rate_a
            success_b = survives_b * sides[1, OTHER, b] * rate_b
            overlaps_a = hit_a * sides[0, SHARE, b] * rate_a
            overlaps_b = hit_b * sides[1, SHARE, a] * rate_b
            lost_a = min(1.0, (1.0 - survives_a) / hit_a)
            lost_b = min(1.0, (1.0 - survives_b) / hit_b)
            common = min(overlaps_a, overlaps_b) * lost_a * lost_b
            rates[a, b, SUCCESS_A], rates[a, b, SUCCESS_B] = success_a, success_b
            rates[a, b, COMMON] = common
            rates[a, b, LOSS_A] = max(0.0, rate_a - success_a - common)
            rates[a, b, LOSS_B] = max(0.0, rate_b - success_b - common)


@inlined
def _fill_spread(rates: FloatArray, spread: FloatArray) -> None:
    """Fill P(a, b) of interior states as linear in the boundary states."""
    for a in range(1, STAGES):
        for b in range(1, STAGES):
            out = rates[a, b, 0] + rates[a, b, 1] + rates[a, b, 2]
            out = out + rates[a, b, 3] + rates[a, b, 4]
            into_common = rates[a - 1, b - 1, COMMON] / out
            into_a, into_b = rates[a - 1, b, LOSS_A] / out, rates[a, b - 1, LOSS_B] / out
            for origin in range(BOUNDARY):
                cell = into_common * spread[a - 1, b - 1, origin]
                cell = cell + into_a * spread[a - 1, b, origin]
                spread[a, b, origin] = cell + into_b * spread[a, b - 1, origin]


@inlined
def _fill_flow(rates: FloatArray, spread: FloatArray, flow: FloatArray) -> None:
    """Fill the rates between boundary states, to one from another."""
    flow[:] = 0.0
    for stage in range(STAGES):
        top, side, below = stage, STAGES - 1 + stage if stage else BOUNDARY, stage - 1
        for k in range(STAGES):
            _add(flow, top, rates, SUCCESS_A, spread, (k, stage))
            _add(flow, side, rates, SUCCESS_B, spread, (stage, k))
        _add(flow, top, rates, LOSS_A, spread, (LAST, stage))
        _add(flow, side, rates, LOSS_B, spread, (stage, LAST))
        if stage:
            _add(flow, top, rates, LOSS_B, spread, (0, below))
            _add(flow, top, rates, COMMON, spread, (LAST, below))
            _add(flow, side, rates, LOSS_A, spread, (below, 0))
            _add(flow, side, rates, COMMON, spread, (below, LAST))
    for origin in range(BOUNDARY):  # what flows into (0, 0) as a state of both kinds
        flow[0, origin] += flow[BOUNDARY, origin]
    _add(flow, 0, rates, COMMON, spread, (LAST, LAST))


@inlined
def _add(
    flow: FloatArray,
    target: int,
    rates: FloatArray,
    kind: int,
    spread: FloatArray,
    state: tuple[int, int],
) -> None:
    """Add what flows out of one state into a boundary state."""
    a, b = state
    rate = rates[a, b, kind]
    for origin in range(BOUNDARY):
        flow[target, origin] += rate * spread[a, b, origin]


@inlined
def _eliminate(flow: FloatArray, result: FloatArray) -> None:
    """Fill the stationary distribution, up to a factor; flows are to one state from another."""
    for last in range(BOUNDARY - 1, 0, -1):
        leaves = flow[0, last]
        for state in range(1, last):
            leaves = leaves + flow[state, last]
        for origin in range(last):
            flow[last, origin] /= leaves
        for state in range(last):
            rate = flow[state, last]
            for origin in range(last):
                flow[state, origin] += flow[last, origin] * rate
    result[0] = 1.0
    for state in range(1, BOUNDARY):
        inflow = result[0] * flow[state, 0]
        for origin in range(1, state):
            inflow = inflow + result[origin] * flow[state, origin]
        result[state] = inflow


@inlined
def _weigh(spread: FloatArray, boundary: FloatArray, joint: FloatArray, chain: int) -> None:
    """Fill P(a, b) of one chain."""
    total = 0.0
    for a in range(STAGES):
        for b in range(STAGES):
            cell = spread[a, b, 0] * boundary[0]
            for origin in range(1, b + 1):  # (0, b) and (a, 0) lead to no lower stage
                cell = cell + spread[a, b, origin] * boundary[origin]
            for origin in range(STAGES, STAGES + a):
                cell = cell + spread[a, b, origin] * boundary[origin]
            joint[chain, a, b] = cell
            total = total + cell
    for a in range(STAGES):
        for b in range(STAGES):
            joint[chain, a, b] /= total


@inlined
def stage_means(
    alone: FloatArray, known: Records, given: FloatArray, by_stage: FloatArray
) -> FloatArray:
    """Return the mean over the stages b of the other side, given a, shape (relations, 7).

    Args:
        alone: Time-weighted stages of the interferer of each relation, for want of a chain.
        known: The relations that have one.
        given: P(b | a) of these.
        by_stage: What is averaged, by b.
    """
    result = np.empty(by_stage.shape)
    for at in range(len(by_stage)):
        mean = 0.0
        for b in range(STAGES):
            mean = mean + alone[at, b] * by_stage[at, b]
        for a in range(STAGES):
            result[at, a] = mean
    for place in range(len(known)):
        at = known[place].one
        for a in range(STAGES):
            mean = 0.0
            for b in range(STAGES):
                mean = mean + given[place, a, b] * by_stage[at, b]
            result[at, a] = mean
    return result
