"""How compiled functions read records.

Arrays are handed over as addresses. numba counts references to every array at every call, which
took ten times as long as what the functions do, and half a minute to compile.
"""

import ctypes
from collections.abc import Callable
from typing import Any, TypeAlias, cast

import numpy as np

from ncsim_core.compiling import NUMBA, inlined

Record: TypeAlias = Any
"""``record.field`` reads and writes; numpy's types do not know the fields."""


def reader(dtype: "np.dtype[np.void]") -> Callable[[int], Record]:
    """Return what gives the record at an address."""
    if NUMBA is None:
        return lambda address: _record_in_memory(int(address), dtype)
    intrinsic, record_type = NUMBA.extending.intrinsic, NUMBA.from_dtype(dtype)

    @intrinsic  # type: ignore[untyped-decorator]
    def record_at(_typing: Record, _address: Record) -> Record:
        def generate(target: Record, builder: Record, _: Record, arguments: Record) -> Record:
            return builder.inttoptr(arguments[0], target.get_value_type(record_type))

        return record_type(NUMBA.types.int64), generate

    return cast("Callable[[int], Record]", record_at)


def vector_reader() -> Callable[[int, int], Record]:
    """Return what gives so many whole numbers from an address on, as an array to loop over fast."""
    if NUMBA is None:
        return _vector_in_memory
    carray, types = NUMBA.carray, NUMBA.types

    @NUMBA.extending.intrinsic  # type: ignore[untyped-decorator]
    def pointer_at(_typing: Record, _address: Record) -> Record:
        def generate(target: Record, builder: Record, _: Record, arguments: Record) -> Record:
            return builder.inttoptr(
                arguments[0], target.get_value_type(types.CPointer(types.int64))
            )

        return types.CPointer(types.int64)(types.int64), generate

    def vector_at(address: int, count: int) -> Record:
        return carray(pointer_at(address), count)

    return inlined(vector_at)


def _vector_in_memory(address: int, count: int) -> Record:
    memory: Record = (ctypes.c_char * (8 * int(count))).from_address(int(address))
    return np.frombuffer(memory, np.int64)


def _record_in_memory(address: int, dtype: "np.dtype[np.void]") -> Record:
    memory: Record = (ctypes.c_char * dtype.itemsize).from_address(address)
    return np.frombuffer(memory, dtype).view(np.recarray)[0]
