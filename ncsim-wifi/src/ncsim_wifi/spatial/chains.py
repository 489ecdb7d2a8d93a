"""The back-off stages of two stations that hurt each other, as one Markov chain.

After a common loss one side escapes to stage 0 and starves the other, which no assumption of
independence reproduces.

Source: MODEL 3.10.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ncsim_wifi.quantities import FloatArray, IntArray
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.sums import row_sums

BOUNDARY = 2 * STAGES - 1
STATES = STAGES * STAGES  # (a, b) is number 7 a + b
STEPS_BACK = (STAGES + 1, STAGES, 1)  # both lost a frame before, or a, or b
DIAGONALS = [
    np.array([STAGES * a + both - a for a in range(1, STAGES) if 0 < both - a < STAGES])
    for both in range(2, 2 * STAGES - 1)
]
"""Interior states of equal a + b, which follow from those before."""
INTERIOR = np.concatenate(DIAGONALS)
SOURCES = [np.array([diagonal - back for back in STEPS_BACK]) for diagonal in DIAGONALS]
SLICES = [slice(diagonal[0], diagonal[-1] + 1, STAGES - 1) for diagonal in DIAGONALS]
PLACES = np.cumsum([0, *map(len, DIAGONALS)]).tolist()


class SideRates(NamedTuple):
    """One side of each chain; ``b`` is the other side's stage, ``a`` its own.

    Shape (7, chains), but (chains, 7) in compiled functions.

    Args:
        survives: s_b.
        hit: Probability that a frame is overlapped, by b.
        share: phi_b, that the other side is the one that overlaps.
        other: o(a), what else a frame has to survive.
        cycle_us: Mean time between attempts in stage a.
        grows: By what loss grows with stage a, relative to its mean.
    """

    survives: FloatArray
    hit: FloatArray
    share: FloatArray
    other: FloatArray
    cycle_us: FloatArray
    grows: FloatArray


class ChainRates(NamedTuple):
    """Transitions per microsecond from state (a, b), shape (7, 7, chains).

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
    rate_a, rate_b = 1.0 / one.cycle_us[:, None], 1.0 / two.cycle_us
    survives_a = np.maximum(0.0, 1.0 - one.grows[:, None] * (1.0 - one.survives))
    survives_b = np.maximum(0.0, 1.0 - two.grows * (1.0 - two.survives)[:, None])
    hit_a, hit_b = np.maximum(one.hit, 1e-12), np.maximum(two.hit, 1e-12)[:, None]
    success_a = survives_a * one.other[:, None] * rate_a
    success_b = survives_b * two.other * rate_b
    overlaps = np.minimum((hit_a * one.share) * rate_a, (hit_b * two.share[:, None]) * rate_b)
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


def joint_stages(one: SideRates, two: SideRates) -> FloatArray:
    """Return the time-weighted distribution P(a, b) of each chain, shape (chains, 7, 7)."""
    return stationary(chain_rates(one, two))


def stationary(rates: ChainRates) -> FloatArray:
    """Return the time-weighted distribution P(a, b) of each chain, shape (chains, 7, 7).

    Interior states follow from the 13 states with a = 0 or b = 0 by forward substitution; what
    flows among these, directly or through the interior, is a chain of 13 states.

    Source: MODEL 3.10.
    """
    by_state = ChainRates(*(rate[..., None] for rate in rates))
    out = by_state.success_a + by_state.success_b + by_state.common
    out += by_state.loss_a
    out += by_state.loss_b
    spread = _by_boundary(by_state, out)
    boundary = eliminated(_boundary_inflow(by_state, spread).transpose(2, 0, 1))
    joint = row_sums(spread * boundary.T).transpose(2, 0, 1)
    totals = row_sums(joint.reshape(len(joint), -1))
    return np.asarray(joint / totals[:, None, None])


def eliminated(flow: FloatArray) -> FloatArray:
    """Return stationary distributions, up to a factor, by eliminating states from the last on.

    Nothing is subtracted, so that small probabilities are as accurate as large ones.

    Source: Grassmann, Taksar and Heyman (1985), Operations Research 33.

    Args:
        flow: Rate from one state to another, shape (states from, states to, chains).

    Returns:
        Shape (states, chains).
    """
    flow = flow.copy()
    for last in range(len(flow) - 1, 0, -1):
        leaving, entering, rest = flow[last, :last], flow[:last, last], flow[:last, :last]
        entering /= np.add.accumulate(leaving, axis=0)[-1]
        rest += entering[:, None] * leaving
    result: FloatArray = flow[0].copy()
    result[0] = 1.0
    for state in range(1, len(flow) - 1):
        later = result[state + 1 :]
        later += result[state] * flow[state, state + 1 :]
    return result


def _by_boundary(rates: ChainRates, out: FloatArray) -> FloatArray:
    """Return P(a, b) as linear in the boundary states, shape (7, 7, chains, 13)."""
    spread = np.zeros((STAGES, STAGES, rates.common.shape[2], BOUNDARY))
    stage = np.arange(STAGES)
    spread[0, stage, :, stage] = 1.0
    spread[stage[1:], 0, :, stage[1:] + STAGES - 1] = 1.0
    flat = spread.reshape(STATES, *spread.shape[2:])
    into = _into_interior(rates, out)
    for cells, sources, (begin, end) in zip(SLICES, SOURCES, pairwise(PLACES), strict=True):
        terms = flat.take(sources, axis=0)
        terms *= into[:, begin:end]
        np.add.reduce(terms, axis=0, out=flat[cells])
    return spread


def _into_interior(rates: ChainRates, out: FloatArray) -> FloatArray:
    """Return the rates into interior states over what leaves them.

    Returns:
        From the three states before, by place in ``INTERIOR``, shape (3, 36, chains, 1).
    """
    ways = rates.common, rates.loss_a, rates.loss_b
    into = np.empty((len(ways), len(INTERIOR), *out.shape[2:]))
    for way, (rate, back) in enumerate(zip(ways, STEPS_BACK, strict=True)):
        rate.reshape(STATES, -1, 1).take(INTERIOR - back, axis=0, out=into[way])
    into /= out.reshape(STATES, -1, 1).take(INTERIOR, axis=0)
    return into


def _boundary_inflow(rates: ChainRates, spread: FloatArray) -> FloatArray:
    """Return the rates into boundary states, by that and by that of origin, (13, chains, 13)."""
    last = STAGES - 1
    inflow = np.empty((BOUNDARY, *spread.shape[2:]))
    top = inflow[:STAGES]  # states (0, b)
    np.add.reduce(rates.success_a * spread, axis=0, out=top)
    side = np.add.reduce(rates.success_b * spread, axis=1)  # states (a, 0)
    top += rates.loss_a[last] * spread[last]
    top[1:] += rates.loss_b[0, :-1] * spread[0, :-1]
    top[1:] += rates.common[last, :-1] * spread[last, :-1]
    side += rates.loss_b[:, last] * spread[:, last]
    side[1:] += rates.loss_a[:-1, 0] * spread[:-1, 0]
    side[1:] += rates.common[:-1, last] * spread[:-1, last]
    top[0] += side[0]
    top[0] += rates.common[last, last] * spread[last, last]
    inflow[STAGES:] = side[1:]
    return inflow


class Given(NamedTuple):
    """What is known of the stages of the other side.

    Args:
        alone: Time-weighted stages of the interferer of each relation, for want of a chain.
        relation: The relations that have one.
        stages: P(b | a) of these, shape (some relations, 7, 7).
    """

    alone: FloatArray
    relation: IntArray
    stages: FloatArray


def stage_means(given: Given, by_stage: FloatArray) -> FloatArray:
    """Return the mean over the stages b of the other side, given a, shape (relations, 7).

    Args:
        given: How likely they are.
        by_stage: What is averaged, by b, shape (relations, 7).
    """
    result = np.empty_like(by_stage)
    result[:] = row_sums(given.alone * by_stage)[:, None]
    result[given.relation] = row_sums(given.stages * by_stage[given.relation][:, None, :])
    return result
