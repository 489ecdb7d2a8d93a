"""The hazard of a weak interferer when stronger ones may be on at the same time.

Source: MODEL 3.7.
"""

import numpy as np

from ncsim_wifi.quantities import BoolArray, FloatArray

LARGEST_KILL = 1.0 - 1e-9


def overlap_us(
    on_air_us: FloatArray, cycle_us: FloatArray, protected_us: FloatArray, scale: float
) -> FloatArray:
    """Return L_o, for how long an interferer overlaps a frame that it overlaps at all.

    Source: MODEL 3.7.

    Args:
        on_air_us: T_w of the interferer.
        cycle_us: Mean time from one of its frames to the next.
        protected_us: V_p of the link.
        scale: Calibrated factor.
    """
    on = on_air_us / cycle_us
    met = np.minimum(1.0, (protected_us + on_air_us) / cycle_us)
    return np.asarray(scale * np.minimum(on_air_us, on * protected_us / met))


def meets_probability(on: FloatArray, on_air_us: FloatArray, window_us: FloatArray) -> FloatArray:
    """Return x_k, the probability that a helper is on at some time during a window.

    Source: MODEL 3.7.

    Args:
        on: a_k, the part of time it is on.
        on_air_us: T_k, for how long at a time.
        window_us: L_o.
    """
    off_us = on_air_us * (1.0 / on - 1.0)
    return np.asarray(
        1.0 - (1.0 - on) * np.maximum(0.0, 1.0 - window_us / np.maximum(off_us, 1e-9))
    )


def joint_kill(
    delta: FloatArray, omega: FloatArray, present: FloatArray, helper_sets: BoolArray
) -> FloatArray:
    """Return kd, the part of overlapped frames lost to an interferer beyond what helpers take.

    Source: MODEL 3.7.

    Args:
        delta: Extra hazard beyond that of each set of helpers, shape (relations, sets).
        omega: Weight of each set, 0 where impossible.
        present: x_k, shape (relations, helpers), 0 where there is none.
        helper_sets: Which helpers a set holds.
    """
    chance = np.where(helper_sets[None], present[:, None, :], 1.0 - present[:, None, :])
    weight = omega * chance.prod(axis=2)
    kill = (weight * -np.expm1(-delta / 2.0)).sum(axis=1) / np.maximum(weight.sum(axis=1), 1e-300)
    return np.asarray(np.minimum(kill, LARGEST_KILL))
