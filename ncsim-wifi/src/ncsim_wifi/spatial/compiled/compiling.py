"""How loops are compiled."""

from collections.abc import Callable
from typing import TypeVar, cast

from ncsim_wifi.quantities import FloatArray

F = TypeVar("F", bound=Callable[..., object])


def compiled(function: F) -> F:
    """Return a function compiled, kept on disk where that is possible; as it is without numba."""
    try:
        import numba
    except ImportError:
        return function
    try:
        return cast("F", numba.njit(cache=True, error_model="numpy")(function))
    except RuntimeError:  # no folder to keep it in
        return cast("F", numba.njit(error_model="numpy")(function))


@compiled
def halving_sum(terms: FloatArray) -> float:
    """Return the sum of a power of two of terms, which are overwritten: first plus second half."""
    half = len(terms) // 2
    while half:
        for place in range(half):
            terms[place] += terms[half + place]
        half //= 2
    return float(terms[0])
