"""The gaps between frames of hidden stations, relation by relation.

Source: MODEL 3.8; see ``ncsim_wifi.spatial.gaps``.
"""

import math
from typing import NamedTuple

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.mac.timing import SLOT_us
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.attempts import GAUSS_WEIGHT
from ncsim_wifi.spatial.backoff import LONGEST_COUNTS, STAGES, WINDOWS
from ncsim_wifi.spatial.gaps import NEARLY_ONE, Interferers, Survival, Windows

MOMENTS = 4


class Relation(NamedTuple):
    """One relation; as in ``Interferers`` and ``Windows``, and how many slots windows hold."""

    left_us: FloatArray
    counts: FloatArray
    borne_us: FloatArray
    after_us: float
    on_air_us: float
    rest_us: float
    immune: float
    is_strong: bool
    before: float
    during: float


@inlined
def survival(met: Interferers, windows: Windows) -> Survival:
    """Return what frames survive, partly overlapped ones included."""
    count = len(met.others)
    survives, missed, found_free = np.empty((3, count, STAGES))
    moments = np.empty((int(windows.longest_us / SLOT_us) + 2, MOMENTS))
    mean_count = np.empty(STAGES)
    counts = np.empty(len(windows.left_us))
    for at in range(count):
        relation = _relation(met, windows, at, counts)
        _mean_counts(met.share[at], met.others[at], mean_count)
        count_us = _count_us(met, at, mean_count)
        interrupted = (count_us - SLOT_us) / (met.neighbour_us[at] - SLOT_us)
        interrupted = min(max(interrupted, 0.0), 1.0)
        last = int(max(0.0, counts.max()))
        _fill_moments((1.0 - interrupted) * met.others[at], moments[: last + 1])
        for stage in range(STAGES):
            law = _ending(met.share[at, stage], met.others[at], stage)
            mean_us = relation.after_us + count_us * mean_count[stage]
            found = _outcome(relation, moments, law, mean_us, LONGEST_COUNTS[stage])
            survives[at, stage], missed[at, stage], found_free[at, stage] = found
    return Survival(survives, missed, found_free)


@inlined
def _relation(met: Interferers, windows: Windows, at: int, counts: FloatArray) -> Relation:
    """Return one relation; fill how many slots each window holds."""
    after_us = met.after_us[at]
    for number in range(len(counts)):
        counts[number] = math.floor((windows.left_us[number, at] - after_us) / SLOT_us)
    return Relation(
        windows.left_us[:, at],
        counts,
        windows.borne_us[:, at],
        after_us,
        met.on_air_us[at],
        met.on_air_us[at] + met.overhead_us[at] - after_us,
        windows.immune[at],
        windows.is_strong[at],
        windows.before[at],
        windows.during[at],
    )


@inlined
def _mean_counts(share: FloatArray, others: float, mean_count: FloatArray) -> None:
    """Fill Em_k of one relation."""
    power = others
    for _ in range(4):
        power = power * power
    for stage in range(STAGES):
        last = LONGEST_COUNTS[stage]
        if others > NEARLY_ONE:
            zeroth, first = last + 1.0, last * (last + 1.0) / 2.0
            second = last * (last + 1.0) * (2.0 * last + 1.0) / 6.0
        else:
            zeroth = (1.0 - power) / (1.0 - others)
            first = (zeroth - 1.0 - last * power) / (1.0 - others)
            second = (2.0 * first - zeroth + 1.0 - last * last * power) / (1.0 - others)
        linear, square = _law(share[stage], stage)
        mean_count[stage] = zeroth - 1.0 - linear * first + square * second
        power = power * power


@inlined
def _law(share: float, stage: int) -> tuple[float, float]:
    window = WINDOWS[stage]
    return (2.0 - share) / window, (1.0 - share) / (window * window)


@inlined
def _count_us(met: Interferers, at: int, mean_count: FloatArray) -> float:
    """Return D_G of one relation."""
    counts = 0.0
    for stage in range(STAGES):
        counts += met.stages[at, stage] * mean_count[stage]
    counting_us = met.busy_us[at] * (1.0 / met.sum_on[at] - 1.0) - met.spare_us[at]
    return float(max(SLOT_us, counting_us / counts))


@inlined
def _fill_moments(base: float, moments: FloatArray) -> None:
    """Fill the sums over n' <= n of n'^i base^n'."""
    term = 1.0
    moments[0] = 0.0
    moments[0, 0] = 1.0
    for n in range(1, len(moments)):
        term = term * base
        power = 1.0
        for order in range(MOMENTS):
            moments[n, order] = moments[n - 1, order] + term * power
            power = power * n


@inlined
def _outcome(
    relation: Relation,
    moments: FloatArray,
    law: tuple[float, float, float],
    mean_us: float,
    longest: float,
) -> tuple[float, float, float]:
    """Return s_k, nohit_k and how likely the receiver is free, of one relation and stage."""
    cycle_us = mean_us + relation.rest_us
    full = mean_us / cycle_us if relation.is_strong else 1.0
    survives = relation.immune * full
    missed = room_us = 0.0
    for number in range(len(relation.left_us)):
        left_us = relation.left_us[number]
        last = min(relation.counts[number], longest)
        ends, spare_us = _short(left_us - relation.after_us, law, last, moments)
        room_us = max(0.0, mean_us - left_us + spare_us)
        if number == 0:
            missed = room_us / cycle_us
        elif number <= len(GAUSS_WEIGHT):
            partly_us = 0.0 if relation.is_strong else relation.borne_us[number - 1] * (1.0 - ends)
            weight = (1.0 - relation.immune) * GAUSS_WEIGHT[number - 1]
            survives = survives + weight * min((room_us + partly_us) / cycle_us, full)
    on_part, before, during = relation.on_air_us / cycle_us, relation.before, relation.during
    return (
        _gated(survives, on_part, before, during),
        _gated(missed, on_part, before, during),
        room_us / cycle_us,
    )


@inlined
def _ending(share: float, others: float, stage: int) -> tuple[float, float, float]:
    """Return c_0, c_1 and c_2 of P_k(n) = (c_0 + c_1 n + c_2 n^2) y^n."""
    linear, square = _law(share, stage)
    return (
        1.0 - others * (1.0 - linear + square),
        -linear + others * (linear - 2.0 * square),
        square * (1.0 - others),
    )


@inlined
def _short(
    room_us: float, law: tuple[float, float, float], last: float, moments: FloatArray
) -> tuple[float, float]:
    """Return P(gap < v) and E(v - gap)^+ of uninterrupted gaps."""
    if last < 0.0:
        return 0.0, 0.0
    n = int(last)
    ends = law[0] * moments[n, 0] + law[1] * moments[n, 1] + law[2] * moments[n, 2]
    counted = law[0] * moments[n, 1] + law[1] * moments[n, 2] + law[2] * moments[n, 3]
    return ends, room_us * ends - SLOT_us * counted


@inlined
def _gated(survives: float, on_part: float, before: float, during: float) -> float:
    """Return survival when summed power keeps the two apart part of the time."""
    at_start = min(1.0 - survives, on_part)
    lost = at_start * before + (1.0 - survives - at_start) * during
    return 1.0 - lost / max(1.0 - on_part * (1.0 - before), 1e-9)
