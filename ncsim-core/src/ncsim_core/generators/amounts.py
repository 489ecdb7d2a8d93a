"""Quantities of a generated scenario: one number, a list that is cycled, or a range."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle, islice
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True)
class Uniform:
    """Numbers drawn evenly between two bounds."""

    low: float
    high: float


Amount: TypeAlias = float | Sequence[float] | Uniform


def amounts(amount: Amount, count: int, stream: "np.random.Generator") -> list[float]:
    """Return ``count`` numbers; only a range draws from the stream.

    >>> amounts((1.0, 2.0), 3, None)
    [1.0, 2.0, 1.0]
    """
    if isinstance(amount, Uniform):
        return [float(each) for each in stream.uniform(amount.low, amount.high, count)]
    if isinstance(amount, int | float):
        return [float(amount)] * count
    return list(islice(cycle(map(float, amount)), count))
