"""Where the trace of a run is at this moment."""

from ncsim_core.trace.files import TRACE_NAMES

from ncsim_viz.server.errors import RequestError
from ncsim_viz.server.library import Library
from ncsim_viz.server.tail import Source


def source_of(library: Library, run: str) -> Source | None:
    """Return where the trace of a run is; ``None`` if there is no such run."""
    try:
        place = library.run(run)
    except RequestError:
        return None
    is_running = place.stage == "running"
    path = place.trace or (place.folder / TRACE_NAMES[0] if is_running else None)
    if path is None:
        return None
    fate = "abandoned" if place.stage == "abandoned" else "truncated"
    return Source(path, is_running, fate)
