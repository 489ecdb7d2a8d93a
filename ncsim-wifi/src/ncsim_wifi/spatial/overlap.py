"""The hazard of a weak interferer when stronger ones may be on at the same time.

Source: MODEL 3.7.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.quantities import FloatArray, IntArray

LARGEST_KILL, LEAST_KILL = 1.0 - 1e-9, 5e-10
LARGEST_ON = 0.97
LEAST_ON = 1e-9


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


def half_kill(delta: FloatArray) -> FloatArray:
    """Return the part of frames lost that an extra hazard overlaps half (MODEL 3.7)."""
    return -np.expm1(-delta / 2.0)


def joint_kill(kill: FloatArray, omega: FloatArray, present: FloatArray) -> FloatArray:
    """Return kd, the part of overlapped frames lost to an interferer beyond what helpers take.

    Source: MODEL 3.7.

    Args:
        kill: Part of frames lost beyond what each set of helpers takes, shape (relations, 1, sets);
            set number s holds helper i if bit i of s is set.
        omega: Weight of each set, 0 where impossible.
        present: x_k, shape (relations, stages, helpers), 0 where there is none.
    """
    both = np.concatenate([(omega * kill)[None], omega[None]])
    away = 1.0 - present
    for helper in range(present.shape[2] - 1, -1, -1):
        half = both.shape[3] // 2
        without = both[..., :half] * away[:, :, helper, None]
        both = without + both[..., half:] * present[:, :, helper, None]
    killed, total = both[..., 0]
    return np.asarray(np.minimum(killed / np.maximum(total, 1e-300), LARGEST_KILL))


class Helped(NamedTuple):
    """The relations that may act together with others, and with whom.

    Args:
        own: The station that sends.
        station: The one that it suffers from.
        protected_us: V_p of its link.
        helper: Who may help, -1 for nobody, shape (relations, helpers).
        kill: Part of frames lost beyond what each set of helpers takes, shape (relations, sets).
        omega: Weight of each set.
        scale: Calibrated factor of the overlap.
    """

    own: IntArray
    station: IntArray
    protected_us: FloatArray
    helper: IntArray
    kill: FloatArray
    omega: FloatArray
    scale: float


def helped_kill(
    helped: Helped, on: FloatArray, on_air_us: FloatArray, busy_us: FloatArray, eager: FloatArray
) -> FloatArray:
    """Return kd of each of these relations, by stage of the sender.

    Source: MODEL 3.7.

    Args:
        helped: The relations.
        on: A[u, w].
        on_air_us: T of each station.
        busy_us: For how long a frame of each station keeps others from counting.
        eager: How much more often than on average helpers attempt while the sender is in a
            stage, shape (relations, helpers, stages); one stage stands for all.
    """
    own, station, helper = helped.own, helped.station, helped.helper
    own_on = np.minimum(np.maximum(on[own, station], LEAST_ON), LARGEST_ON)
    window_us = overlap_us(
        on_air_us[station], busy_us[station] / own_on, helped.protected_us, helped.scale
    )
    helper_on = np.minimum(np.maximum(on[own[:, None], helper], LEAST_ON), LARGEST_ON)
    helper_on = helper_on * (on_air_us / busy_us)[helper]
    by_stage = np.minimum(helper_on[:, None, :] * eager.transpose(0, 2, 1), LARGEST_ON)
    met = meets_probability(by_stage, on_air_us[helper][:, None, :], window_us[:, None, None])
    present = np.where((helper >= 0)[:, None, :], met, 0.0)
    return joint_kill(helped.kill[:, None, :], helped.omega[:, None, :], present)
