"""Interferers that exclude each other on the air: what frames survive all of them together.

Source: MODEL 3.8.
"""

from typing import NamedTuple

import numpy as np

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.elementary import exp, log
from ncsim_wifi.spatial.relations import Hostile
from ncsim_wifi.spatial.sums import row_sums

LEAST_HIT = 0.05
LEAST_PART = 1e-9


class Members(NamedTuple):
    """The interferers of each relation as members of groups.

    Args:
        phi: phi_j, share of the member in the frames of its group, shape (relations,).
        share: The same given its stage, shape (relations, 7).
        alone: Time-weighted stages of the member.
        survives: What would survive if all frames of the group were like the member's, by stage.
    """

    phi: FloatArray
    share: FloatArray
    alone: FloatArray
    survives: FloatArray


def met_at_once(
    window_us: FloatArray, on_air_us: FloatArray, cycle_us: FloatArray, hit: FloatArray
) -> FloatArray:
    """Return n, how many frames of a group overlap one that is overlapped at all.

    Args:
        window_us: V_r.
        on_air_us: For how long one of them is on.
        cycle_us: Mean time from one to the next.
        hit: Part of frames that are overlapped.
    """
    return np.maximum(1.0, (window_us + on_air_us) / cycle_us / np.maximum(hit, LEAST_HIT))


def in_company(hostile: Hostile, members: Members, number: FloatArray) -> FloatArray:
    """Return what survives a whole group, by stage of each member.

    A frame that n frames overlap, each of a random member, survives with the n-th power of the
    mean over members of the n-th root of what would survive if all were like the member's.

    Source: MODEL 3.8.

    Args:
        hostile: Hidden relations.
        members: Their interferers.
        number: n.
    """
    phi, share, alone, survives = members
    some, root = hostile.of_several, hostile.group_sums(phi / number)[:, None]
    result = survives.copy()
    roots = np.zeros_like(survives)
    roots[some] = exp(root[some] * log(np.maximum(survives[some], LEAST_PART)))
    mean = phi * row_sums(alone * roots)
    rest = (hostile.group_sums(mean) - mean) / np.maximum(1.0 - phi, LEAST_PART)
    mixed = share * roots + (1.0 - share) * rest[:, None]
    result[some] = exp(log(mixed[some]) / root[some])
    return result


def in_company_by_cts(hostile: Hostile, members: Members) -> FloatArray:
    """Return the same under RTS/CTS, where members have windows of different kinds: the mean."""
    phi, share, alone, survives = members
    in_group = hostile.group_sums(phi * row_sums(alone * survives))[:, None]
    several = hostile.is_member_of_several[:, None]
    return np.where(several, share * survives + (1.0 - share) * in_group, survives)
