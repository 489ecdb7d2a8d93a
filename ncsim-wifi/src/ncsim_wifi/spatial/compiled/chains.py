"""The back-off stages of two stations that hurt each other, chain by chain.

Source: MODEL 3.10; see ``ncsim_wifi.spatial.chains``.
"""

import numpy as np

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.chains import BOUNDARY, SideRates
from ncsim_wifi.spatial.compiled.compiling import inlined

LAST = STAGES - 1
KINDS = 5
SUCCESS_A, SUCCESS_B, COMMON, LOSS_A, LOSS_B = range(KINDS)


@inlined
def joint_stages(one: SideRates, two: SideRates) -> FloatArray:
    """Return the time-weighted distribution P(a, b) of each chain, shape (chains, 7, 7)."""
    count = len(one.hit)
    joint = np.empty((count, STAGES, STAGES))
    rates = np.empty((STAGES, STAGES, KINDS))
    spread = np.zeros((STAGES, STAGES, BOUNDARY))
    for stage in range(STAGES):
        spread[0, stage, stage] = 1.0
        spread[stage, 0, stage + STAGES - 1 if stage else 0] = 1.0
    flow = np.empty((BOUNDARY, BOUNDARY))
    boundary = np.empty(BOUNDARY)
    for chain in range(count):
        for a in range(STAGES):
            for b in range(STAGES):
                _fill_rates(one, two, (chain, a, b), rates[a, b])
        _fill_spread(rates, spread)
        _fill_flow(rates, spread, flow)
        _eliminate(flow, boundary)
        _weigh(spread, boundary, joint[chain])
    return joint


@inlined
def _fill_rates(
    one: SideRates, two: SideRates, state: tuple[int, int, int], rates: FloatArray
) -> None:
    """Fill the rates out of one state of one chain."""
    chain, a, b = state
    rate_a, rate_b = 1.0 / one.cycle_us[chain, a], 1.0 / two.cycle_us[chain, b]
    survives_a, survives_b = one.survives[chain, b], two.survives[chain, a]
    hit_a, hit_b = max(one.hit[chain, b], 1e-12), max(two.hit[chain, a], 1e-12)
    success_a = survives_a * one.other[chain, a] * rate_a
    success_b = survives_b * two.other[chain, b] * rate_b
    overlaps = min(hit_a * one.share[chain, b] * rate_a, hit_b * two.share[chain, a] * rate_b)
    lost_a = min(1.0, (1.0 - survives_a) / hit_a)
    lost_b = min(1.0, (1.0 - survives_b) / hit_b)
    common = overlaps * lost_a * lost_b
    rates[SUCCESS_A], rates[SUCCESS_B], rates[COMMON] = success_a, success_b, common
    rates[LOSS_A] = max(0.0, rate_a - success_a - common)
    rates[LOSS_B] = max(0.0, rate_b - success_b - common)


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
    side = np.empty(BOUNDARY)
    for stage in range(STAGES):
        top, below = flow[stage], stage - 1
        side[:] = 0.0
        for k in range(STAGES):
            _add(top, rates[k, stage, SUCCESS_A], spread[k, stage])
            _add(side, rates[stage, k, SUCCESS_B], spread[stage, k])
        _add(top, rates[LAST, stage, LOSS_A], spread[LAST, stage])
        _add(side, rates[stage, LAST, LOSS_B], spread[stage, LAST])
        if stage:
            _add(top, rates[0, below, LOSS_B], spread[0, below])
            _add(top, rates[LAST, below, COMMON], spread[LAST, below])
            _add(side, rates[below, 0, LOSS_A], spread[below, 0])
            _add(side, rates[below, LAST, COMMON], spread[below, LAST])
            flow[STAGES - 1 + stage] = side
        else:
            _add(top, 1.0, side)
            _add(top, rates[LAST, LAST, COMMON], spread[LAST, LAST])


@inlined
def _add(inflow: FloatArray, rate: float, spread: FloatArray) -> None:
    """Add what flows out of one state."""
    for origin in range(BOUNDARY):
        inflow[origin] += rate * spread[origin]


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
def _weigh(spread: FloatArray, boundary: FloatArray, joint: FloatArray) -> None:
    """Fill P(a, b) of one chain."""
    total = 0.0
    for a in range(STAGES):
        for b in range(STAGES):
            joint[a, b] = spread[a, b, 0] * boundary[0]
            for origin in range(1, BOUNDARY):
                joint[a, b] += spread[a, b, origin] * boundary[origin]
            total = total + joint[a, b]
    for a in range(STAGES):
        for b in range(STAGES):
            joint[a, b] /= total
