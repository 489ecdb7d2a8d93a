"""Whether a frame fits into the gap between two frames of a hidden station.

Back-off counters are uniform, not exponential, so the gaps are short and similar; what a frame
survives follows from their distribution.

Source: MODEL 3.8.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ncsim_wifi.mac.timing import SLOT_us
from ncsim_wifi.quantities import BoolArray, FloatArray
from ncsim_wifi.spatial.attempts import GAUSS_AT, GAUSS_WEIGHT
from ncsim_wifi.spatial.backoff import WINDOWS


class CounterLaw(NamedTuple):
    """P(remaining count >= n) = (1 - n linear + n^2 square) y^n for n up to the window.

    A fresh counter is uniform, one found on the way has a residual law; the other members of
    the group go on with geometric counters.

    Args:
        linear: (2 - phi) / W, shape (relations, 7).
        square: (1 - phi) / W^2.
        others: y, probability that no other member starts in a slot, shape (relations, 1).
    """

    linear: FloatArray
    square: FloatArray
    others: FloatArray


def counter_law(share: FloatArray, others: FloatArray) -> CounterLaw:
    """Return the law of the count between frames of a group.

    Source: MODEL 3.8, S_k(n).

    Args:
        share: phi_k, probability that the station itself has just sent, shape (relations, 7).
        others: y_o, shape (relations,).
    """
    return CounterLaw((2.0 - share) / WINDOWS, (1.0 - share) / WINDOWS**2, others[:, None])


def power_sums(base: FloatArray, last: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the sums over n = 0..last of y^n, n y^n and n^2 y^n, for y up to 1.

    >>> [float(s) for s in power_sums(np.array(1.0), np.array(3.0))]
    [4.0, 6.0, 14.0]
    """
    is_one = base > 1.0 - 1e-4  # attempt probabilities are 0.002 or more, or 0
    of_one = last + 1.0, last * (last + 1.0) / 2.0, last * (last + 1.0) * (2.0 * last + 1.0) / 6.0
    if is_one.all():
        return of_one
    y = np.where(is_one, 0.5, base)
    tail = y ** (last + 1.0)
    zeroth = (1.0 - tail) / (1.0 - y)
    first = (zeroth - 1.0 - last * tail) / (1.0 - y)
    second = (2.0 * first - zeroth + 1.0 - last**2 * tail) / (1.0 - y)
    return (
        np.where(is_one, of_one[0], zeroth),
        np.where(is_one, of_one[1], first),
        np.where(is_one, of_one[2], second),
    )


def mean_remaining_count(law: CounterLaw) -> FloatArray:
    """Return Em_k, the mean count between two frames of a group, shape (relations, 7).

    Source: MODEL 3.8, the sum of S_k(n) over n >= 1.
    """
    zeroth, first, second = power_sums(law.others, WINDOWS - 1.0)
    return zeroth - 1.0 - law.linear * first + law.square * second


@dataclass(frozen=True)
class Gaps:
    """The gaps between frames of an interferer's group, by relation and stage.

    Args:
        law: Law of the counters.
        mean_count: Em_k of that law.
        on_air_us: T, how long a frame of the interferer is on, shape (relations,).
        after_us: ov, the part of a gap that is not counted down.
        overhead_us: ovh, from the end of data until its sender may count.
        count_us: D_G, mean duration of a count.
        interrupted: kappa, probability that a count is interrupted.
        longest_us: The longest window asked about.
    """

    law: CounterLaw
    mean_count: FloatArray
    on_air_us: FloatArray
    after_us: FloatArray
    overhead_us: FloatArray
    count_us: FloatArray
    interrupted: FloatArray
    longest_us: float

    @cached_property
    def mean_us(self) -> FloatArray:
        """Return Gbar_k, the mean gap."""
        return self.after_us[:, None] + self.count_us[:, None] * self.mean_count

    @cached_property
    def cycle_us(self) -> FloatArray:
        """Return the mean time from one frame to the next."""
        return self.mean_us + (self.on_air_us + self.overhead_us - self.after_us)[:, None]

    @cached_property
    def _moments(self) -> FloatArray:
        """Return the sums over n <= N of n^i ((1 - kappa) y)^n, shape (4, relations * (N + 1))."""
        n = np.arange(int(self.longest_us / SLOT_us) + 2, dtype=np.float64)
        terms = np.empty((len(self.after_us), len(n)))
        terms[:, 0] = 1.0
        terms[:, 1:] = ((1.0 - self.interrupted) * self.law.others[:, 0])[:, None]
        np.multiply.accumulate(terms, axis=1, out=terms)
        moments = terms[None] * np.array([np.ones_like(n), n, n**2, n**3])[:, None, :]
        return np.add.accumulate(moments, axis=2, out=moments).reshape(4, -1)

    @cached_property
    def _ending(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return c_0, c_1 and c_2 of P_k(n) = (c_0 + c_1 n + c_2 n^2) y^n, shape (relations, 7)."""
        linear, square, others = self.law
        return (
            1.0 - others * (1.0 - linear + square),
            -linear + others * (linear - 2.0 * square),
            square * (1.0 - others),
        )

    def short(self, window_us: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return P(gap < v) and E(v - gap)^+ of uninterrupted gaps.

        Source: MODEL 3.8, the sums over n <= (v - ov) / sigma.

        Args:
            window_us: v, shape (windows, relations, 1).
        """
        room_us = window_us - self.after_us[:, None]
        last = np.minimum(np.floor(room_us / SLOT_us), WINDOWS - 1.0)
        count = self._moments.shape[1] // len(self.after_us)
        rows = np.arange(0, self._moments.shape[1], count)[:, None]
        at = rows + np.maximum(last, 0.0).astype(np.int64)
        of_0, of_1, of_2, of_3 = self._moments[:, at]
        one, by_n, by_square = self._ending
        ends = one * of_0 + by_n * of_1 + by_square * of_2
        counted = one * of_1 + by_n * of_2 + by_square * of_3
        some = last >= 0.0
        return np.where(some, ends, 0.0), np.where(some, room_us * ends - SLOT_us * counted, 0.0)

    def room_us(self, window_us: FloatArray) -> FloatArray:
        """Return E_k(v) = E(gap - v)^+, the room for starting a window in a gap.

        Source: MODEL 3.8.

        Args:
            window_us: v, shape (relations,).
        """
        spare_us = self.short(window_us[None, :, None])[1][0]
        return np.asarray(np.maximum(0.0, self.mean_us - window_us[:, None] + spare_us))


class Survival(NamedTuple):
    """What an interferer in each stage does to a frame, shape (relations, 7).

    Args:
        survives: s_k, probability that the frame survives.
        missed: nohit_k, probability that no frame of the interferer overlaps it.
    """

    survives: FloatArray
    missed: FloatArray


def survival(
    gaps: Gaps,
    window_us: FloatArray,
    protected_us: FloatArray,
    hazard: FloatArray,
    is_strong: BoolArray,
) -> Survival:
    """Return what frames survive, partly overlapped ones included.

    A frame dies once the overlapped part of its payload reaches a random length, which the
    hazard gives; three Gauss points stand for it.

    Source: MODEL 3.8, nohit_k and s_k.

    Args:
        gaps: Gaps of the interferer's group.
        window_us: V_r, shape (relations,).
        protected_us: V_p of the link.
        hazard: h_r.
        is_strong: Whether an interferer that is on at the start kills whatever the overlap.
    """
    immune = np.exp(-hazard)
    lethal = -np.log1p(-GAUSS_AT[:, None] * (1.0 - immune)) / hazard
    borne_us = np.zeros((4, len(hazard), 1))  # nothing, and three random lengths
    borne_us[1:, :, 0] = np.minimum(1.0, lethal) * protected_us
    left_us = window_us[:, None] - borne_us
    ends, spare_us = gaps.short(left_us)
    room_us = np.maximum(0.0, gaps.mean_us - left_us + spare_us)
    missed = room_us[0] / gaps.cycle_us
    full = np.where(is_strong[:, None], gaps.mean_us / gaps.cycle_us, 1.0)
    partly_us = np.where(is_strong[:, None], 0.0, borne_us * (1.0 - ends))
    partly = np.minimum((room_us + partly_us) / gaps.cycle_us, full)
    weights = (1.0 - immune) * GAUSS_WEIGHT[:, None]
    survives = immune[:, None] * full
    for weight, part in zip(weights, partly[1:], strict=True):
        survives = survives + weight[:, None] * part
    return Survival(survives, missed)
