"""The back-off stages of two stations that hurt each other, as one Markov chain.

After a common loss one side escapes to stage 0 and starves the other, which no assumption of
independence reproduces.

Source: MODEL 3.10.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.backoff import STAGES

BOUNDARY = 2 * STAGES - 1


class SideRates(NamedTuple):
    """One side of each chain; ``b`` is the other side's stage, ``a`` its own.

    Args:
        survives: s_b, shape (chains, 7).
        hit: Probability that a frame is overlapped, by b.
        share: phi_b, that the other side is the one that overlaps.
        other: o(a), what else a frame has to survive.
        cycle_us: Mean time between attempts in stage a.
    """

    survives: FloatArray
    hit: FloatArray
    share: FloatArray
    other: FloatArray
    cycle_us: FloatArray


class ChainRates(NamedTuple):
    """Transitions per microsecond from state (a, b), shape (chains, 7, 7).

    Args:
        success_a: a returns to 0.
        success_b: b returns to 0.
        common: Both lose a frame.
        loss_a: Only a loses one.
        loss_b: Only b does.
    """

    success_a: FloatArray
    success_b: FloatArray
    common: FloatArray
    loss_a: FloatArray
    loss_b: FloatArray


def chain_rates(one: SideRates, two: SideRates) -> ChainRates:
    """Return the transition rates of chains between two sides.

    Source: MODEL 3.10.
    """
    rate_a, rate_b = 1.0 / one.cycle_us[:, :, None], 1.0 / two.cycle_us[:, None, :]
    survives_a, survives_b = one.survives[:, None, :], two.survives[:, :, None]
    hit_a = np.maximum(one.hit[:, None, :], 1e-12)
    hit_b = np.maximum(two.hit[:, :, None], 1e-12)
    success_a = survives_a * one.other[:, :, None] * rate_a
    success_b = survives_b * two.other[:, None, :] * rate_b
    overlaps = np.minimum(
        hit_a * one.share[:, None, :] * rate_a, hit_b * two.share[:, :, None] * rate_b
    )
    lost_a = np.minimum(1.0, (1.0 - survives_a) / hit_a)
    lost_b = np.minimum(1.0, (1.0 - survives_b) / hit_b)
    common = overlaps * lost_a * lost_b
    return ChainRates(
        success_a,
        success_b,
        common,
        np.maximum(0.0, rate_a - success_a - common),
        np.maximum(0.0, rate_b - success_b - common),
    )


def stationary(rates: ChainRates) -> FloatArray:
    """Return the time-weighted distribution P(a, b) of each chain, shape (chains, 7, 7).

    Interior states follow from the 13 states with a = 0 or b = 0 by forward substitution;
    balance of these and normalisation give a small system.

    Source: MODEL 3.10.
    """
    spread = _by_boundary(rates)
    residual = _boundary_inflow(rates, spread) - _boundary_outflow(rates)
    residual[:, -1, :] = spread.sum(axis=(1, 2))
    right = np.zeros((len(residual), BOUNDARY, 1))
    right[:, -1] = 1.0
    boundary = np.linalg.solve(residual, right)
    joint = np.maximum(0.0, (spread @ boundary[:, None])[..., 0])
    return np.asarray(joint / joint.sum(axis=(1, 2), keepdims=True))


def _by_boundary(rates: ChainRates) -> FloatArray:
    """Return P(a, b) as linear in the boundary states, shape (chains, 7, 7, 13)."""
    count = len(rates.common)
    spread = np.zeros((count, STAGES, STAGES, BOUNDARY))
    stage = np.arange(STAGES)
    spread[:, 0, stage, stage] = 1.0
    spread[:, stage[1:], 0, stage[1:] + STAGES - 1] = 1.0
    out = rates.success_a + rates.success_b + rates.common + rates.loss_a + rates.loss_b
    into_common, into_a, into_b = (
        rate[..., None] for rate in (rates.common, rates.loss_a, rates.loss_b)
    )
    for diagonal in range(2, BOUNDARY):
        a = np.arange(max(1, diagonal - STAGES + 1), min(STAGES - 1, diagonal - 1) + 1)
        b = diagonal - a
        spread[:, a, b] = (
            into_common[:, a - 1, b - 1] * spread[:, a - 1, b - 1]
            + into_a[:, a - 1, b] * spread[:, a - 1, b]
            + into_b[:, a, b - 1] * spread[:, a, b - 1]
        ) / out[:, a, b, None]
    return spread


def _boundary_outflow(rates: ChainRates) -> FloatArray:
    """Return the outflow of the boundary states on a diagonal, shape (chains, 13, 13)."""
    out = rates.success_a + rates.success_b + rates.common + rates.loss_a + rates.loss_b
    flow = np.zeros((len(out), BOUNDARY, BOUNDARY))
    each = np.arange(BOUNDARY)
    flow[:, each, each] = np.concatenate([out[:, 0, :], out[:, 1:, 0]], axis=1)
    return flow


def _boundary_inflow(rates: ChainRates, spread: FloatArray) -> FloatArray:
    """Return what flows into the boundary states, shape (chains, 13, 13)."""
    last = STAGES - 1
    inflow = np.zeros((len(spread), BOUNDARY, BOUNDARY))
    top = inflow[:, :STAGES]  # states (0, b)
    top += np.einsum("cab,cabx->cbx", rates.success_a, spread)
    top += rates.loss_a[:, last, :, None] * spread[:, last]
    top[:, 1:] += rates.loss_b[:, 0, :-1, None] * spread[:, 0, :-1]
    top[:, 1:] += rates.common[:, last, :-1, None] * spread[:, last, :-1]
    side = np.zeros((len(spread), STAGES, BOUNDARY))  # states (a, 0)
    side += np.einsum("cab,cabx->cax", rates.success_b, spread)
    side += rates.loss_b[:, :, last, None] * spread[:, :, last]
    side[:, 1:] += rates.loss_a[:, :-1, 0, None] * spread[:, :-1, 0]
    side[:, 1:] += rates.common[:, :-1, last, None] * spread[:, :-1, last]
    top[:, 0] += side[:, 0]
    top[:, 0] += rates.common[:, last, last, None] * spread[:, last, last]
    inflow[:, STAGES:] = side[:, 1:]
    return inflow
