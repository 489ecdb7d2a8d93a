"""Results on disk: ``results.sqlite`` in the folder of a study.

Write-ahead log, one transaction per chunk: whatever happens to the process, what was committed is
there, and nothing is there twice. Results are kept by key, so that every sweep into the same
folder reuses them; ``member`` says which runs of which plan they belong to.
"""

import json
import os
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, Final, Self

from ncsim_core.errors import ScenarioError
from ncsim_core.sweep.damage import checked_row, is_whole, reading
from ncsim_core.sweep.plan import SweepPlan, canonical, plan_from_json
from ncsim_core.sweep.worker import Item, ResultRow

STORE_NAME: Final = "results.sqlite"
FORMAT: Final = "1"
BUSY_s: Final = 60.0
LOOKUP: Final = 500
"""Keys per query; SQLite takes 999 parameters everywhere."""
RETRIED: Final = ("failed", "limit_reached")

_TABLES = """
CREATE TABLE IF NOT EXISTS meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS plan (
  digest TEXT PRIMARY KEY, name TEXT NOT NULL, document TEXT NOT NULL, runs INTEGER NOT NULL,
  turn INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS member (
  plan TEXT NOT NULL, number INTEGER NOT NULL, point TEXT NOT NULL, seed INTEGER NOT NULL,
  key TEXT NOT NULL, PRIMARY KEY (plan, number)) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS result (
  key TEXT PRIMARY KEY, status TEXT NOT NULL, makespan_us INTEGER, ended_us INTEGER,
  events INTEGER, transfers INTEGER, remote_MB REAL, route_work_MB_hops REAL,
  wall_s REAL NOT NULL, error TEXT) WITHOUT ROWID;
"""
_COLUMNS = ", ".join(ResultRow._fields)
_MARKS = ", ".join("?" for _ in ResultRow._fields)
_CHANGES = ", ".join(f"{name} = excluded.{name}" for name in ResultRow._fields[1:])
_SAVE = (
    f"INSERT INTO result ({_COLUMNS}) VALUES ({_MARKS}) "
    f"ON CONFLICT (key) DO UPDATE SET {_CHANGES} WHERE result.status <> 'completed'"
)
_ALL_RESULTS = f"SELECT {_COLUMNS} FROM result"
_ALL_PLANS = "SELECT digest, name, document, runs, turn FROM plan"
_ALL_MEMBERS = "SELECT plan, number, point, seed, key FROM member"


class Store:
    """The results of a study.

    Args:
        path: The study's folder, or ``None`` to keep results in memory only.

    Raises:
        ScenarioError: It cannot be opened, or is of another format.
    """

    def __init__(self, path: Path | None, *, must_exist: bool = False) -> None:
        self.path = path
        file = None if path is None else path / STORE_NAME
        if file is not None and must_exist and not file.exists():
            raise ScenarioError(f"{path}: holds no {STORE_NAME}; is it the folder of a sweep?")
        if path is not None and path.exists() and not path.is_dir():
            raise ScenarioError(f"{path}: is a file; a study is a folder")
        if path is not None:
            path.mkdir(parents=True, exist_ok=True)
        with self._reading():
            if file is not None and must_exist and not os.access(file.parent, os.W_OK):
                self._connection = _opened_for_reading(file)
            else:
                self._connection = _opened(file)
            self._check_format()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the file."""
        self._connection.close()

    def register(self, plan: SweepPlan, runs: int) -> None:
        """Make ``plan`` the study's current one."""
        with self._transaction() as connection:
            turn = connection.execute("SELECT coalesce(max(turn), 0) + 1 FROM plan").fetchone()[0]
            connection.execute(
                "INSERT INTO plan VALUES (?, ?, ?, ?, ?) ON CONFLICT (digest) DO UPDATE SET "
                "name = excluded.name, document = excluded.document, turn = excluded.turn",
                (plan.digest, plan.name, plan.to_json(), runs, turn),
            )

    def current(self) -> tuple[SweepPlan, int]:
        """Return the plan that was worked on last, and its number of runs.

        Raises:
            ScenarioError: There is none.
        """
        query = "SELECT document, runs, digest FROM plan ORDER BY turn DESC LIMIT 1"
        with self._reading():
            row = self._connection.execute(query).fetchone()
            if row is None:
                raise ScenarioError(f"{self.path}: holds no sweep")
            document, runs, digest = row
            plan = plan_from_json(document)
            if plan.digest != digest or not is_whole(runs):
                raise ValueError("the sweep in it is not the one that was put in")
            return plan, runs

    def enrol(self, plan: SweepPlan, items: Sequence[Item]) -> None:
        """Note which runs belong to a plan."""
        with self._transaction() as connection:
            connection.executemany(
                "INSERT OR REPLACE INTO member VALUES (?, ?, ?, ?, ?)",
                [
                    (
                        plan.digest,
                        item.run.number,
                        canonical(item.run.values),
                        item.run.seed,
                        item.key,
                    )
                    for item in items
                ],
            )

    def save(self, rows: Iterable[ResultRow]) -> None:
        """Keep results, all or none of them; a completed run is never replaced.

        Raises:
            ScenarioError: The disk is full or cannot be written.
        """
        with self._transaction() as connection:
            connection.executemany(_SAVE, rows)

    def finished(self, keys: Sequence[str], *, retry_failed: bool = False) -> dict[str, ResultRow]:
        """Return what is there already of some keys.

        Args:
            keys: Any number of them.
            retry_failed: Pass over runs that failed or reached a limit.
        """
        found: dict[str, ResultRow] = {}
        for start in range(0, len(keys), LOOKUP):
            part = keys[start : start + LOOKUP]
            marks = ", ".join("?" * len(part))
            query = f"SELECT {_COLUMNS} FROM result WHERE key IN ({marks})"
            with self._reading():
                rows = list(map(checked_row, self._connection.execute(query, part)))
            found |= {row.key: row for row in rows if not (retry_failed and row.status in RETRIED)}
        return found

    def rows(self) -> Iterator[tuple[tuple[Any, ...], int, ResultRow | None]]:
        """Yield values, seed and result of each run of the current plan, in file order."""
        plan, _ = self.current()
        columns = ", ".join(f"result.{name}" for name in ResultRow._fields)
        query = (
            f"SELECT point, seed, {columns} FROM member LEFT JOIN result "
            "ON result.key = member.key WHERE plan = ? ORDER BY number"
        )
        with self._reading():
            for text, seed, *result in self._connection.execute(query, (plan.digest,)):
                point = tuple(json.loads(text))
                if len(point) != len(plan.columns) or not is_whole(seed):
                    raise ValueError(f"{text!r} with seed {seed!r} is no run of the sweep")
                yield point, seed, None if result[0] is None else checked_row(result)

    def counts(self) -> dict[str, int]:
        """Return how many runs of the current plan ended how."""
        plan, _ = self.current()
        query = (
            "SELECT status, count(*) FROM member JOIN result ON result.key = member.key "
            "WHERE plan = ? GROUP BY status ORDER BY status"
        )
        with self._reading():
            return dict(self._connection.execute(query, (plan.digest,)).fetchall())

    def errors(self, most: int) -> list[tuple[str, str, int]]:
        """Return status, error and number of runs of the most frequent errors."""
        plan, _ = self.current()
        query = (
            "SELECT status, error, count(*) AS runs FROM member JOIN result "
            "ON result.key = member.key WHERE plan = ? AND error IS NOT NULL "
            "GROUP BY status, error ORDER BY runs DESC, status, error LIMIT ?"
        )
        with self._reading():
            return [tuple(row) for row in self._connection.execute(query, (plan.digest, most))]

    def merge(self, other: "Store") -> None:
        """Take over all that another study holds."""
        read, source = other._read, other._connection  # noqa: SLF001 - of the same class
        with other._reading():  # noqa: SLF001 - likewise
            results = source.execute(_ALL_RESULTS)
            plans = source.execute(_ALL_PLANS)
            members = source.execute(_ALL_MEMBERS)
        with self._transaction() as connection:
            connection.executemany(_SAVE, read(results, checked_row))
            connection.executemany("INSERT OR IGNORE INTO plan VALUES (?, ?, ?, ?, ?)", read(plans))
            connection.executemany(
                "INSERT OR IGNORE INTO member VALUES (?, ?, ?, ?, ?)", read(members)
            )

    def _read(
        self, cursor: sqlite3.Cursor, checked: Callable[[tuple[Any, ...]], tuple[Any, ...]] = tuple
    ) -> Iterator[tuple[Any, ...]]:
        """Yield rows of this study, checked."""
        with self._reading():
            yield from map(checked, cursor)

    def _reading(self) -> AbstractContextManager[None]:
        return reading(Path(STORE_NAME) if self.path is None else self.path / STORE_NAME)

    def _transaction(self) -> "_Transaction":
        return _Transaction(self._connection, self.path)

    def _check_format(self) -> None:
        query = "SELECT value FROM meta WHERE key = 'format'"
        row = self._connection.execute(query).fetchone()
        found = None if row is None else row[0]
        if found != FORMAT:
            raise ScenarioError(f"{self.path}: is of format {found}, this ncsim reads {FORMAT}")


def _opened(file: Path | None) -> sqlite3.Connection:
    """Return a connection to a study that may be written, its tables made if need be."""
    connection = sqlite3.connect(file or ":memory:", timeout=BUSY_s)
    try:
        connection.execute("PRAGMA journal_mode=WAL")
    except sqlite3.OperationalError:  # some network file systems cannot; as safe, only slower
        connection.execute("PRAGMA journal_mode=DELETE")
    connection.executescript(_TABLES)
    with connection:
        connection.execute("INSERT OR IGNORE INTO meta VALUES ('format', ?)", (FORMAT,))
    return connection


def _opened_for_reading(file: Path) -> sqlite3.Connection:
    """Return a connection to a study where nobody may write, such as a colleague's."""
    return sqlite3.connect(f"{file.resolve().as_uri()}?mode=ro&immutable=1", uri=True)


class _Transaction:
    """All or nothing, with a message that helps when the disk is full."""

    def __init__(self, connection: sqlite3.Connection, path: Path | None) -> None:
        self._connection = connection
        self._path = path

    def __enter__(self) -> sqlite3.Connection:
        return self._connection

    def __exit__(self, kind: object, error: BaseException | None, _: object) -> None:
        try:
            if error is None:
                self._connection.commit()
            else:
                self._connection.rollback()
        except sqlite3.OperationalError as failure:
            error = failure
        if isinstance(error, sqlite3.OperationalError):
            raise ScenarioError(
                f"{self._path}: {error}; all results up to here are kept, run the same command "
                "again when there is room"
            ) from error
