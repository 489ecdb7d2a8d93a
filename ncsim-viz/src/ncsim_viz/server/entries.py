"""What the list of runs and studies says about each, read once and again when it has changed."""

import json
from collections.abc import Mapping
from itertools import islice
from pathlib import Path
from typing import Final, TypeAlias

from ncsim_core.errors import NcsimError
from ncsim_core.sweep.store import STORE_NAME, Store
from ncsim_core.trace.output import METRICS_NAME
from ncsim_core.trace.reader import read_trace
from ncsim_core.trace.run_trace import TRUNCATED
from ncsim_core.units import s_from_us

from ncsim_viz.server.library import Library, Place, Stage
from ncsim_viz.server.tail import last_record

MAX_ENTRIES: Final = 2000
MAX_KNOWN: Final = 4 * MAX_ENTRIES

Entry: TypeAlias = dict[str, object]
Stamp: TypeAlias = tuple[int, int]


class Entries:
    """Describes runs and studies, remembering what did not change.

    Args:
        library: Where they are.
    """

    def __init__(self, library: Library) -> None:
        self._library = library
        self._known: dict[tuple[Path, Stage], tuple[Stamp, Entry]] = {}

    def document(self) -> dict[str, object]:
        """Return the list, ready for JSON."""
        places = self._library.places()
        entries = [self.entry(place) for place in islice(places, MAX_ENTRIES)]
        left_out = sum(1 for _ in places)
        return {"title": self._library.title, "entries": entries, "left_out": left_out}

    def entry(self, place: Place) -> Entry:
        """Return what the list says about one run or study."""
        trace = place.trace
        path = place.folder / STORE_NAME if place.kind == "study" else trace
        size, changed = stamp(path or place.folder / METRICS_NAME)
        if place.kind == "study":  # what is written last is in its log
            changed = max(changed, stamp(place.folder / f"{STORE_NAME}-wal")[1])
        head: Entry = {
            "id": place.id,
            "kind": place.kind,
            "is_live": place.stage == "running",
            "modified_s": changed / 1e9,
            "bytes": size if path is not None and place.kind == "run" else None,
        }
        return head | self._remembered(place, (size, changed))

    def _remembered(self, place: Place, changed: Stamp) -> Entry:
        key = place.folder, place.stage
        known = self._known.get(key)
        if known is None or known[0] != changed:
            try:
                about = _study(place) if place.kind == "study" else _run(place)
            except (NcsimError, OSError, ValueError) as error:
                about = _unreadable(place, error)
            if len(self._known) > MAX_KNOWN:  # of folders that are gone
                self._known.clear()
            self._known[key] = known = (changed, about)
        return known[1]


def stamp(path: Path) -> Stamp:
    """Return size and time of change of a file; zeros if it is not there."""
    try:
        status = path.stat()
    except OSError:
        return 0, 0
    return status.st_size, status.st_mtime_ns


def _run(place: Place) -> Entry:
    """Return what a run's files say; metrics are quicker to read than a trace."""
    name, plugins = place.id.rpartition("/")[2], {}
    if place.trace is not None:
        with read_trace(place.trace) as reader:
            preamble = reader.preamble
        name = preamble.header.scenario or name
        plugins = {kind: each.name for kind, each in preamble.plugins.items()}
    status, makespan_s = _ending(place)
    return {"name": name, "status": status, "makespan_s": makespan_s, "plugins": plugins}


def _ending(place: Place) -> tuple[str, float | None]:
    """Return how a run ended and its makespan, if it has one."""
    if place.stage != "finished":
        return place.stage, None
    metrics = _json(place.folder / METRICS_NAME)
    if metrics is not None:
        makespan_s = metrics.get("makespan_s")
        return str(metrics.get("status")), makespan_s if isinstance(makespan_s, float) else None
    done = None if place.trace is None else last_record(place.trace)
    if done is None:
        return TRUNCATED, None
    us = done.get("makespan_us")
    return str(done.get("status")), s_from_us(us) if isinstance(us, int) else None


def _json(path: Path) -> Mapping[str, object] | None:
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return document if isinstance(document, dict) else None


def _study(place: Place) -> Entry:
    with Store(place.folder, must_exist=True) as store:
        plan, planned = store.current()
        ended = sum(store.counts().values())
    status = "completed" if ended >= planned else "running"
    return {
        "name": plan.name,
        "status": status,
        "makespan_s": None,
        "plugins": {},
        "planned": planned,
        "ended": ended,
    }


def _unreadable(place: Place, error: Exception) -> Entry:
    """Return an entry for what cannot be read; a live run may just not have a header yet."""
    name = place.id.rpartition("/")[2]
    about: Entry = {"name": name, "status": place.stage, "makespan_s": None, "plugins": {}}
    if place.stage == "running":
        return about
    return about | {"status": TRUNCATED, "error": str(error)}
