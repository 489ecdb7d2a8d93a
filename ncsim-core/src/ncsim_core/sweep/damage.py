"""What cannot be in a study's file is told of with the file's name: others may have written it."""

import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ncsim_core.errors import ScenarioError
from ncsim_core.sweep.worker import ResultRow


@contextmanager
def reading(file: Path) -> Iterator[None]:
    """Turn what goes wrong in the block, where a file is read, into one message with its name.

    Raises:
        ScenarioError: The file is damaged, is no study, or cannot be used now.
    """
    try:
        yield
    except sqlite3.Error as error:
        raise ScenarioError(f"{file}: cannot be used as a study: {error}") from error
    except (ValueError, TypeError, LookupError, AttributeError, RecursionError) as error:
        said = f"{error.args[0]!r} is missing" if isinstance(error, KeyError) else str(error)
        raise ScenarioError(f"{file}: is damaged: {said}") from error


def is_whole(value: object) -> bool:
    """Return whether a value of a study is a whole number, as SQLite does not see to it."""
    return type(value) is int


def checked_row(values: Sequence[Any]) -> ResultRow:
    """Return a result as it is kept, its values of the kinds they must be.

    Raises:
        ValueError: One is not.
    """
    row = ResultRow._make(values)
    wholes = (row.makespan_us, row.ended_us, row.events, row.transfers)
    numbers = (row.remote_MB, row.route_work_MB_hops)
    is_sound = (
        all(isinstance(each, str) for each in (row.key, row.status))
        and all(each is None or is_whole(each) for each in wholes)
        and all(each is None or type(each) in (int, float) for each in numbers)
        and type(row.wall_s) in (int, float)
        and isinstance(row.error, str | None)
    )
    if not is_sound:
        raise ValueError(f"{tuple(row)!r} is no result")
    return row
