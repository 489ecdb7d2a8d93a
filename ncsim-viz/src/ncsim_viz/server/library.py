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
from typing import Final, Literal, NamedTuple, TypeAlias

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
FILES: Final = RUN_FILE_NAMES | {STORE_NAME}
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
        return next(filter(_is_file, found), None)


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
        """Yield all runs and studies, folder by folder; every folder is read once."""
        waiting: list[tuple[Path, int, Place | None]] = [(self.root, 0, None)]
        seen = 0
        while waiting and seen < MAX_FOLDERS:
            folder, depth, unfinished = waiting.pop()
            seen += 1
            listing = _listed(folder, self.root)
            place = _chosen(self._finished(folder, listing), unfinished)
            if place is not None:
                yield place
            coming = self._unfinished(folder, listing.folders)
            visible = [name for name in listing.folders if not name.startswith(".")]
            yield from (coming[name] for name in sorted(coming.keys() - set(visible)))
            if depth < MAX_DEPTH:
                below = ((folder / name, depth + 1, coming.get(name)) for name in visible)
                waiting += reversed(list(below))

    def find(self, identity: str) -> Place:
        """Return the run or study with an id; of two, the one that is being written.

        Raises:
            RequestError: There is none below the root.
        """
        path = path_below(self.root, identity)
        unfinished = None
        if path != self.root:  # looked at first: it may become the finished one meanwhile
            siblings = _listed(path.parent, self.root).folders
            unfinished = self._unfinished(path.parent, siblings).get(path.name)
        place = _chosen(self._finished(path, _listed(path, self.root)), unfinished)
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
            is_shown = stage == "running" or place.trace is not None
            if is_better and is_shown and not _listed(place.folder, self.root).leads_out:
                found[match["name"]] = place
        return found

    def _finished(self, path: Path, listing: "_Listing") -> Place | None:
        """Return what a folder itself is, if anything."""
        if listing.leads_out:
            return None
        if STORE_NAME in listing.files:
            return Place(self._id(path), path, "study")
        is_run = not listing.files.isdisjoint((*TRACE_NAMES, METRICS_NAME))
        return Place(self._id(path), path, "run") if is_run else None

    def _id(self, path: Path) -> str:
        return path.relative_to(self.root).as_posix()


class _Listing(NamedTuple):
    """What is in a folder.

    Args:
        folders: Names of folders, links left aside, in order.
        files: Names of files of runs and studies.
        leads_out: Whether one of those is a link to somewhere else.
    """

    folders: list[str]
    files: frozenset[str]
    leads_out: bool


def _listed(folder: Path, root: Path) -> _Listing:
    """Return what is in a folder; nothing if it is none, or may not be read."""
    folders: list[str] = []
    files: list[str] = []
    links: list[str] = []
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        for each in entries:
            if each.is_dir(follow_symlinks=False):
                folders.append(each.name)
            elif each.name in FILES:
                (links if each.is_symlink() else files).append(each.name)
    leads_out = any(not is_inside(folder / name, root) for name in links)
    return _Listing(sorted(folders), frozenset(files + links), leads_out)


def _chosen(finished: Place | None, unfinished: Place | None) -> Place | None:
    """Return the one to show: a run under way, else a finished one, else what is left of one."""
    if unfinished is not None and (finished is None or unfinished.stage == "running"):
        return unfinished
    return finished


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # in a folder that may not be read
        return False


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
