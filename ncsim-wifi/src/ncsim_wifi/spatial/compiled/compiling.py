"""How loops are compiled."""

from collections.abc import Callable
from types import ModuleType
from typing import Final, TypeVar, cast

from ncsim_wifi.quantities import FloatArray

F = TypeVar("F", bound=Callable[..., object])


def _numba() -> ModuleType | None:
    try:
        import numba
    except (ImportError, OSError):
        return None
    module: ModuleType = numba
    return None if module.config.DISABLE_JIT else module  # those set it who look for a fault


NUMBA: Final = _numba()


def inlined(function: F) -> F:
    """Return a function to be compiled with its callers; as it is without numba.

    Not kept on disk: only compiled functions may call it, and become part of what is kept.
    """
    if NUMBA is None:
        return function
    options = {"error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    return cast("F", NUMBA.njit(**options)(function))


def kept_on_disk(function: F) -> F:
    """Return a function compiled, and kept where that is possible; as it is without numba."""
    if NUMBA is None:
        return function
    try:
        return cast("F", NUMBA.njit(cache=True, error_model="numpy")(function))
    except RuntimeError:  # no folder to keep it in
        return cast("F", NUMBA.njit(error_model="numpy")(function))


@inlined
def halving_sum(terms: FloatArray) -> float:
    """Return the sum of a power of two of terms, which are overwritten: first plus second half."""
    half = len(terms) // 2
    while half:
        for place in range(half):
            terms[place] += terms[half + place]
        half //= 2
    return float(terms[0])
