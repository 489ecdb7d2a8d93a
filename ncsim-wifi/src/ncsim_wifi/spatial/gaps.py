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
from ncsim_wifi.spatial.attempts import GAUSS_WEIGHT
from ncsim_wifi.spatial.backoff import LONGEST_COUNTS, STAGES, WINDOWS
from ncsim_wifi.spatial.sums import row_sums

NEARLY_ONE = 1.0 - 1e-4  # attempt probabilities are 0.002 or more, or 0
COUNTS = np.arange(LONGEST_COUNTS[-1] + 1.0)
POWERS_OF_COUNTS = np.array([np.ones_like(COUNTS), COUNTS, COUNTS**2, COUNTS**3])[:, None, :]


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


def window_powers(base: FloatArray) -> FloatArray:
    """Return y^W of each window by squaring, shape (relations, 7)."""
    power = base * base
    power *= power
    power *= power
    powers = np.empty((STAGES, len(base)))
    np.multiply(power, power, out=powers[0])
    for stage in range(1, STAGES):
        np.multiply(powers[stage - 1], powers[stage - 1], out=powers[stage])
    return powers.T


def power_sums(
    base: FloatArray, last: FloatArray, beyond: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the sums over n = 0..last of y^n, n y^n and n^2 y^n, for y up to 1.

    Args:
        base: y.
        last: The last n.
        beyond: y^(last + 1).

    >>> [float(s) for s in power_sums(np.array(1.0), np.array(3.0), np.array(1.0))]
    [4.0, 6.0, 14.0]
    """
    is_one = base > NEARLY_ONE
    if not is_one.any():
        return _geometric_sums(base, last, beyond)
    sums = _geometric_sums(np.where(is_one, 0.5, base), last, beyond)
    of_ones = (
        last + 1.0,
        last * (last + 1.0) / 2.0,
        last * (last + 1.0) * (2.0 * last + 1.0) / 6.0,
    )
    zeroth, first, second = (
        np.where(is_one, one, other) for one, other in zip(of_ones, sums, strict=True)
    )
    return zeroth, first, second


def _geometric_sums(
    y: FloatArray, last: FloatArray, beyond: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return these sums for y well below 1."""
    away = 1.0 - y
    zeroth = (1.0 - beyond) / away
    first = (zeroth - 1.0 - last * beyond) / away
    second = (2.0 * first - zeroth + 1.0 - last * last * beyond) / away
    return zeroth, first, second


def mean_remaining_count(law: CounterLaw) -> FloatArray:
    """Return Em_k, the mean count between two frames of a group, shape (relations, 7).

    Source: MODEL 3.8, the sum of S_k(n) over n >= 1.
    """
    zeroth, first, second = power_sums(law.others, LONGEST_COUNTS, window_powers(law.others[:, 0]))
    return zeroth - 1.0 - law.linear * first + law.square * second


class Interferers(NamedTuple):
    """The stations that relations are with, as their links meet them; shape (relations,).

    Args:
        share: phi_k, probability that the station itself has just sent, shape (relations, 7).
        others: y_o, probability that no other of its group starts in a slot.
        stages: q_j(k), share of its attempts in each stage, shape (relations, 7).
        busy_us: Mean time that a frame of its group keeps others from counting.
        spare_us: Mean time that its members wait longer than others after their frames.
        sum_on: How much of the time the group is on.
        neighbour_us: T_nb, mean time on the air of what it senses.
        on_air_us: T, how long one of its frames is on.
        overhead_us: ovh, from the end of data until it may count.
        after_us: ov, the part of a gap that is not counted down.
    """

    share: FloatArray
    others: FloatArray
    stages: FloatArray
    busy_us: FloatArray
    spare_us: FloatArray
    sum_on: FloatArray
    neighbour_us: FloatArray
    on_air_us: FloatArray
    overhead_us: FloatArray
    after_us: FloatArray


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
    """

    law: CounterLaw
    mean_count: FloatArray
    on_air_us: FloatArray
    after_us: FloatArray
    overhead_us: FloatArray
    count_us: FloatArray
    interrupted: FloatArray

    @classmethod
    def of(cls, met: Interferers) -> "Gaps":
        """Return the gaps that interferers leave."""
        law = counter_law(met.share, met.others)
        mean_count = mean_remaining_count(law)
        counts = row_sums(met.stages * mean_count)
        counting_us = met.busy_us * (1.0 / met.sum_on - 1.0) - met.spare_us
        count_us = np.maximum(SLOT_us, counting_us / counts)
        interrupted = (count_us - SLOT_us) / (met.neighbour_us - SLOT_us)
        return cls(
            law,
            mean_count,
            met.on_air_us,
            met.after_us,
            met.overhead_us,
            count_us,
            np.minimum(np.maximum(interrupted, 0.0), 1.0),
        )

    @cached_property
    def mean_us(self) -> FloatArray:
        """Return Gbar_k, the mean gap."""
        return self.after_us[:, None] + self.count_us[:, None] * self.mean_count

    @cached_property
    def cycle_us(self) -> FloatArray:
        """Return the mean time from one frame to the next."""
        return self.mean_us + (self.on_air_us + self.overhead_us - self.after_us)[:, None]

    def _moments(self, last: int) -> FloatArray:
        """Return the sums over n <= N of n^i ((1 - kappa) y)^n, shape (4, relations * (N + 1)).

        Args:
            last: The last N.
        """
        terms = np.empty((len(self.after_us), last + 1))
        terms[:, 0] = 1.0
        terms[:, 1:] = ((1.0 - self.interrupted) * self.law.others[:, 0])[:, None]
        np.multiply.accumulate(terms, axis=1, out=terms)
        moments = terms * POWERS_OF_COUNTS[:, :, : last + 1]
        return np.add.accumulate(moments, axis=2, out=moments).reshape(4, -1)

    def _ending(self) -> FloatArray:
        """Return c_0, c_1 and c_2 of P_k(n) = (c_0 + c_1 n + c_2 n^2) y^n.

        Returns:
            Shape (3, 1, relations, 7).
        """
        linear, square, others = self.law
        law = np.empty((3, 1, *linear.shape))
        law[0, 0] = 1.0 - others * (1.0 - linear + square)
        law[1, 0] = -linear + others * (linear - 2.0 * square)
        law[2, 0] = square * (1.0 - others)
        return law

    def short(self, window_us: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return P(gap < v) and E(v - gap)^+ of uninterrupted gaps.

        Source: MODEL 3.8, the sums over n <= (v - ov) / sigma.

        Args:
            window_us: v, shape (windows, relations, 1).
        """
        room_us = window_us - self.after_us[:, None]
        last = np.floor(room_us / SLOT_us)
        moments = self._moments(max(0, int(last.max(initial=0.0))))
        last = np.minimum(last, LONGEST_COUNTS)
        count = moments.shape[1] // max(1, len(self.after_us))
        rows = np.arange(0, moments.shape[1], count)[:, None]
        places = np.maximum(last, 0.0).astype(np.int64)
        found = moments.take(rows + places, axis=1)
        law = self._ending()
        ends = np.add.reduce(law * found[:3], axis=0)
        spare_us = room_us * ends - SLOT_us * np.add.reduce(law * found[1:], axis=0)
        some = last >= 0.0
        if some.all():
            return ends, spare_us
        return np.where(some, ends, 0.0), np.where(some, spare_us, 0.0)


class Windows(NamedTuple):
    """Windows that a frame of an interferer must not begin in.

    Args:
        left_us: V_r, and what is left of it when a random lethal length is borne, three times;
            under RTS/CTS also the window in which the receiver must be free, shape (4 or 5,
            relations).
        borne_us: These three lengths, shape (3, relations).
        immune: Part of frames that any overlap leaves alive, exp(-h).
        is_strong: Whether an interferer that is on at the start kills whatever the overlap.
        before: al, how likely the sender begins while the interferer is on.
        during: be, how likely the interferer begins while the sender is on.
        longest_us: The longest window.
    """

    left_us: FloatArray
    borne_us: FloatArray
    immune: FloatArray
    is_strong: BoolArray
    before: FloatArray
    during: FloatArray
    longest_us: float


def windows_of(
    window_us: FloatArray, protected_us: FloatArray, lethal: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return windows that are left when a random part of the payload may be overlapped.

    A frame dies once the overlapped part of its payload reaches a random length, which the
    hazard h gives; three Gauss points stand for it, -ln(1 - x (1 - exp(-h))) / h.

    Source: MODEL 3.8, X_i.

    Args:
        window_us: V_r, shape (relations,).
        protected_us: V_p of the link.
        lethal: That length as part of the payload, shape (3, relations).

    Returns:
        The windows, shape (4, relations), and the lengths, shape (3, relations).
    """
    borne_us = np.minimum(1.0, lethal) * protected_us
    return np.concatenate([window_us[None], window_us - borne_us]), borne_us


class Survival(NamedTuple):
    """What an interferer in each stage does to a frame, shape (relations, 7).

    Args:
        survives: s_k, probability that the frame survives.
        missed: nohit_k, probability that no frame of the interferer overlaps it.
        found_free: Probability that the receiver is free when asked by an RTS, if that counts.
    """

    survives: FloatArray
    missed: FloatArray
    found_free: FloatArray


def survival(met: Interferers, windows: Windows) -> Survival:
    """Return what frames survive, partly overlapped ones included.

    Source: MODEL 3.8, nohit_k and s_k.
    """
    gaps = Gaps.of(met)
    left_us = windows.left_us[:, :, None]
    ends, spare_us = gaps.short(left_us)
    room_us = np.maximum(0.0, gaps.mean_us - left_us + spare_us)
    is_strong = windows.is_strong[:, None]
    full = np.where(is_strong, gaps.mean_us / gaps.cycle_us, 1.0)
    borne_us = np.where(windows.is_strong, 0.0, windows.borne_us)[:, :, None]
    partly = np.minimum((room_us[1:4] + borne_us * (1.0 - ends[1:4])) / gaps.cycle_us, full)
    weights = (1.0 - windows.immune) * GAUSS_WEIGHT[:, None]
    terms = np.empty((4, *full.shape))
    np.multiply(windows.immune[:, None], full, out=terms[0])
    np.multiply(weights[:, :, None], partly, out=terms[1:])
    survives = np.add.reduce(terms, axis=0)
    on_part = gaps.on_air_us[:, None] / gaps.cycle_us
    missed = room_us[0] / gaps.cycle_us
    both = np.concatenate([survives[None], missed[None]])
    survives, missed = gated(both, on_part, windows.before[:, None], windows.during[:, None])
    return Survival(survives, missed, room_us[-1] / gaps.cycle_us)


def gated(
    survives: FloatArray, on_part: FloatArray, before: FloatArray, during: FloatArray
) -> FloatArray:
    """Return survival when summed power keeps the two apart part of the time (MODEL 3.8)."""
    at_start = np.minimum(1.0 - survives, on_part)
    lost = at_start * before + (1.0 - survives - at_start) * during
    return np.asarray(1.0 - lost / np.maximum(1.0 - on_part * (1.0 - before), 1e-9))
