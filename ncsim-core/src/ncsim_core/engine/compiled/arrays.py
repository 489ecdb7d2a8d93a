"""The arrays of a run by name, and the record of what is there once, which knows where they are."""

from collections.abc import Mapping

import numpy as np

from ncsim_core.engine.compiled.layout import ARRAYS, STATE
from ncsim_core.engine.compiled.records import Record


def records(count: int, dtype: "np.dtype[np.void]", **values: float) -> Record:
    """Return zeroed records, some fields with another value everywhere."""
    made = np.zeros(count, dtype)
    for name, value in values.items():
        made[name] = value
    return made.view(np.recarray)


class Arrays:
    """All records of a run.

    Attributes:
        state: The one record of ``layout.STATE``.
    """

    def __init__(self, **values: int) -> None:
        self._state = records(1, STATE, **values)
        self._by_name: dict[str, Record] = {}
        self.state = self._state[0]

    def __getitem__(self, name: str) -> Record:
        return self._by_name[name]

    def put(self, name: str, array: Record) -> None:
        """Take an array in, in place of the one of that name before.

        Raises:
            ValueError: It is not what the loop takes it for.
        """
        dtype = ARRAYS[name]
        if array.dtype.itemsize != dtype.itemsize or not array.flags.c_contiguous:
            raise ValueError(f"{name}: {array.dtype} in place of {dtype}")
        self._by_name[name] = array
        self._state[name] = array.ctypes.data

    def put_all(self, arrays: Mapping[str, Record]) -> None:
        """Take several arrays in."""
        for name, array in arrays.items():
            self.put(name, array)
