"""Which runs and studies a folder holds, those included that are being written right now.

A run that goes on lies in a hidden folder that takes its name at the end
(``ncsim_core.trace.output``), and its trace grows there.
"""

import contextlib
import os
import re
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal, TypeAlias

from ncsim_core.sweep.store import STORE_NAME
from ncsim_core.trace.files import TRACE_NAMES
from ncsim_core.trace.output import METRICS_NAME, RUN_FILE_NAMES

from ncsim_viz.server.errors import missing
from ncsim_viz.server.guards import is_inside, path_below

MAX_DEPTH: Final = 8
"""Folders within folders that are looked through."""
MAX_FOLDERS: Final = 20_000
FRESH_s: Final = 10.0
"""A run of another machine, whose processes cannot be seen, lives as long as its trace grows."""
PARTIAL: Final = re.compile(r"\.(?P<name>.+)\.partial-(?P<process>\d+)-[0-9a-f]{8}\Z")

Stage: TypeAlias = Literal["finished", "running", "abandoned"]


@dataclass(frozen=True)
class Place:
    """Where a run or study is.

    Args:
        id: Path below the root, with slashes; ``.`` is the root itself.
        folder: Where its files are now.
        kind: What it is.
        stage: Whether its process is still at it, or died.
    """

    id: str
    folder: Path
    kind: Literal["run", "study"]
    stage: Stage = "finished"

    @property
    def trace(self) -> Path | None:
        """Return its trace; ``None`` if it has none that can be read yet."""
        found = (self.folder / name for name in TRACE_NAMES)
        return next((path for path in found if path.is_file()), None)


class Library:
    """The runs and studies below a folder.

    Args:
        root: The folder; nothing outside is ever read, even if a link leads there.
    """

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()

    @property
    def title(self) -> str:
        """Return what people call the folder."""
        return self.root.name or str(self.root)

    def places(self) -> Iterator[Place]:
        """Yield all runs and studies, folder by folder."""
        root = self._finished(self.root)
        if root is not None:
            yield root
        waiting = [(self.root, 0)]
        seen = 0
        while waiting and seen < MAX_FOLDERS:
            folder, depth = waiting.pop()
            seen += 1
            names = _folders_in(folder)
            yield from self._places_in(folder, names)
            if depth < MAX_DEPTH:
                visible = [folder / name for name in names if not name.startswith(".")]
                waiting += [(each, depth + 1) for each in reversed(visible)]

    def find(self, identity: str) -> Place:
        """Return the run or study with an id; of two, the one that is being written.

        Raises:
            RequestError: There is none below the root.
        """
        path = path_below(self.root, identity)
        unfinished = None
        if path != self.root:  # looked at first: it may become the finished one meanwhile
            siblings = _folders_in(path.parent)
            unfinished = self._unfinished(path.parent, siblings).get(path.name)
        place = _chosen(self._finished(path), unfinished)
        if place is None:
            raise missing(repr(identity))
        return place

    def run(self, identity: str) -> Place:
        """Return the run with an id.

        Raises:
            RequestError: There is none.
        """
        return self._of_kind(identity, "run")

    def study(self, identity: str) -> Place:
        """Return the study with an id.

        Raises:
            RequestError: There is none.
        """
        return self._of_kind(identity, "study")

    def _of_kind(self, identity: str, kind: str) -> Place:
        place = self.find(identity)
        if place.kind != kind:
            raise missing(f"{kind} {identity!r}")
        return place

    def _places_in(self, folder: Path, names: list[str]) -> Iterator[Place]:
        """Yield what the folders in a folder are."""
        unfinished = self._unfinished(folder, names)
        visible = {name for name in names if not name.startswith(".")}
        for name in sorted(visible | unfinished.keys()):
            place = _chosen(self._finished(folder / name), unfinished.get(name))
            if place is not None:
                yield place

    def _unfinished(self, folder: Path, names: list[str]) -> dict[str, Place]:
        """Return the runs that are being written into a folder, by the names they are to have."""
        found: dict[str, Place] = {}
        for name in names:
            match = PARTIAL.match(name)
            if match is None or match["name"].startswith("."):
                continue
            is_running = _is_alive(int(match["process"])) or _is_fresh(folder / name)
            stage: Stage = "running" if is_running else "abandoned"
            place = Place(self._id(folder / match["name"]), folder / name, "run", stage)
            earlier = found.get(match["name"])
            is_better = earlier is None or earlier.stage == "abandoned"
            if (
                is_better
                and self._is_contained(place.folder)
                and (stage == "running" or place.trace)
            ):
                found[match["name"]] = place
        return found

    def _finished(self, path: Path) -> Place | None:
        """Return what a folder itself is, if anything."""
        if not path.is_dir() or not self._is_contained(path):
            return None
        if (path / STORE_NAME).is_file():
            return Place(self._id(path), path, "study")
        place = Place(self._id(path), path, "run")
        is_run = place.trace is not None or (path / METRICS_NAME).is_file()
        return place if is_run else None

    def _id(self, path: Path) -> str:
        return path.relative_to(self.root).as_posix()

    def _is_contained(self, folder: Path) -> bool:
        """Return whether a folder and the files that may be read in it are below the root."""
        files = (folder / name for name in (*RUN_FILE_NAMES, STORE_NAME))
        paths = [folder, *(path for path in files if path.is_symlink())]
        return all(is_inside(path, self.root) for path in paths)


def _chosen(finished: Place | None, unfinished: Place | None) -> Place | None:
    """Return the one to show: a run under way, else a finished one, else what is left of one."""
    if unfinished is not None and (finished is None or unfinished.stage == "running"):
        return unfinished
    return finished


def _folders_in(folder: Path) -> list[str]:
    """Return the names of folders, links left aside, in order."""
    try:
        with os.scandir(folder) as entries:
            return sorted(each.name for each in entries if each.is_dir(follow_symlinks=False))
    except OSError:  # not allowed, or gone meanwhile
        return []


def _is_alive(process: int) -> bool:
    """Return whether a process of this machine lives."""
    if sys.platform == "win32":
        return True  # there, os.kill would do something else
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        return True
    return True


def _is_fresh(folder: Path) -> bool:
    """Return whether a run's trace was written to just now."""
    times_s = []
    for name in TRACE_NAMES:
        with contextlib.suppress(OSError):
            times_s.append((folder / name).stat().st_mtime)
    return abs(time.time() - max(times_s, default=0.0)) < FRESH_s
