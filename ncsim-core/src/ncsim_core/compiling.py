"""How functions are compiled, here and in plug-ins; importing this starts numba if it is there."""

from collections.abc import Callable, Iterable
from pathlib import Path
from types import ModuleType
from typing import Final, TypeVar, cast

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

    Not kept on disk: only compiled functions may call it, since it has no wrappers for others, and
    become part of what is kept.
    """
    if NUMBA is None:
        return function
    options = {"error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    return cast("F", NUMBA.njit(**options)(function))


def spliced(function: F) -> F:
    """Return a function to be compiled as if it were written where it is called.

    For a few large functions in a row, each called once: numba would optimize what the innermost
    one calls once for each of them.
    """
    if NUMBA is None:
        return function
    return cast("F", NUMBA.njit(error_model="numpy", inline="always")(function))


def kept_on_disk(function: F) -> F:
    """Return a function compiled, and kept where that is possible; as it is without numba."""
    if NUMBA is None:
        return function
    try:
        return cast("F", NUMBA.njit(cache=True, error_model="numpy")(function))
    except RuntimeError:  # no folder to keep it in
        return cast("F", NUMBA.njit(error_model="numpy")(function))


def state_of(sources: Iterable[Path]) -> str:
    """Return what changes whenever a source file does.

    numba looks at the file of a kept function alone, and at the values that it encloses, to see
    whether what it has kept is still good; so it has to enclose this.
    """
    states = [file.stat() for file in (*sources, Path(__file__))]
    return " ".join(f"{state.st_mtime_ns}-{state.st_size}" for state in states)
