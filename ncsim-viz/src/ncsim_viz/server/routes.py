"""The requests of ``docs/viewer-api.md``, each a function from parameters to plain data."""

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias
from urllib.parse import parse_qs

from ncsim_core.registry import get_registry
from ncsim_core.scenario.schema import compose_schema
from ncsim_core.scenario.yaml_text import dump_yaml
from ncsim_core.trace.loading import load_run

from ncsim_viz.extras import comparison_of, extras_of
from ncsim_viz.server.entries import Entries, stamp
from ncsim_viz.server.errors import bad, conflict
from ncsim_viz.server.jobs import Jobs
from ncsim_viz.server.library import Library, Place
from ncsim_viz.server.presets import preset
from ncsim_viz.server.scenarios import (
    catalogue,
    checked,
    study_scenario,
    task_count,
    validation,
)
from ncsim_viz.study import study_document

MAX_REMEMBERED: Final = 8

Query: TypeAlias = Mapping[str, list[str]]
Answer: TypeAlias = Mapping[str, object]


@dataclass(frozen=True)
class Site:
    """All that requests are answered from.

    Args:
        library: The runs and studies.
        entries: Describes them.
        jobs: The queue; ``None`` if nothing may be run.
        building: Held while models are built, which takes memory.
        computing: Held while a run is summed up, so that it is done once.
        remembered: What was last computed of which runs; of a long one it takes seconds.
    """

    library: Library
    entries: Entries
    jobs: Jobs | None
    building: threading.Lock = field(default_factory=threading.Lock)
    computing: threading.Lock = field(default_factory=threading.Lock)
    remembered: dict[tuple[object, ...], Answer] = field(default_factory=dict)


def query_of(text: str) -> Query:
    """Return the parameters in the query part of an address."""
    try:
        return parse_qs(text, keep_blank_values=True, max_num_fields=50, errors="strict")
    except ValueError as error:
        raise bad(f"the query cannot be read: {error}") from error


def one(query: Query, name: str, default: str | None = None) -> str:
    """Return a parameter that is given once.

    Raises:
        RequestError: It is not given, or twice.
    """
    values = query.get(name, [] if default is None else [default])
    if len(values) != 1:
        raise bad(f"give {name!r} once")
    return values[0]


def _entries(site: Site, _: Query) -> Answer:
    return site.entries.document()


def _extras(site: Site, query: Query) -> Answer:
    names = [one(query, name) for name in ("run", "compare") if name in query or name == "run"]
    places = [_finished(site, name) for name in names]
    key = tuple((place.folder, stamp(place.trace or place.folder)) for place in places)
    with site.computing:
        if key not in site.remembered:
            if len(site.remembered) >= MAX_REMEMBERED:
                site.remembered.pop(next(iter(site.remembered)))
            site.remembered[key] = _computed(places)
        return site.remembered[key]


def _computed(places: Sequence[Place]) -> Answer:
    first, *others = places
    run = load_run(first.folder)
    extras = extras_of(first.folder, run)
    for other in others:
        names = first.id, other.id
        extras["comparison"] = comparison_of(run, load_run(other.folder), names)
    return extras


def _finished(site: Site, identity: str) -> Place:
    place = site.library.run(identity)
    if place.stage == "running":
        raise conflict(f"{identity} is still running")
    return place


def _study(site: Site, query: Query) -> Answer:
    place = site.library.study(one(query, "study"))
    conditions = [text.partition("=") for text in query.get("where", [])]
    return study_document(
        place.folder,
        one(query, "policy", "scheduler"),
        one(query, "mode", "interference"),
        {column: value for column, _, value in conditions},
    )


def _study_scenario(site: Site, query: Query) -> Answer:
    place = site.library.study(one(query, "study"))
    number = one(query, "run")
    if not (number.isascii() and number.isdecimal()):
        raise bad("'run' must be the number of a row")
    return {"yaml": study_scenario(place.folder, int(number))}


def _schema(_: Site, __: Query) -> Answer:
    return compose_schema(get_registry())


def _catalogue(_: Site, __: Query) -> Answer:
    return catalogue()


def _jobs(site: Site, _: Query) -> Answer:
    return _queue(site).document()


def _queue(site: Site) -> Jobs:
    if site.jobs is None:
        raise conflict("nothing can be run here: the folder cannot be written")
    return site.jobs


def _validate(site: Site, body: Mapping[str, Any]) -> Answer:
    with site.building:
        return validation(_text(body, "yaml"))


def _yaml(_: Site, body: Mapping[str, Any]) -> Answer:
    document = body.get("document")
    if not isinstance(document, dict):
        raise bad("'document' must be an object")
    return {"yaml": dump_yaml(document)}


def _preset(_: Site, body: Mapping[str, Any]) -> Answer:
    return preset(body)


def _start(site: Site, body: Mapping[str, Any]) -> Answer:
    text, name = _text(body, "yaml"), body.get("name")
    jobs = _queue(site)
    with site.building:
        scenario, faults = checked(text)
    if scenario is None:
        raise bad("this scenario is not valid", {"faults": faults})
    wish = name if isinstance(name, str) and name else scenario.name
    return {"job": jobs.add(text, wish, task_count(scenario))}


def _cancel(site: Site, body: Mapping[str, Any]) -> Answer:
    return {"job": _queue(site).cancel(_text(body, "job"))}


def _text(body: Mapping[str, Any], name: str) -> str:
    value = body.get(name)
    if not isinstance(value, str):
        raise bad(f"{name!r} must be text")
    return value


GET: Final[Mapping[str, Callable[[Site, Query], Answer]]] = {
    "/api/entries": _entries,
    "/api/extras": _extras,
    "/api/study": _study,
    "/api/study/scenario": _study_scenario,
    "/api/schema": _schema,
    "/api/catalogue": _catalogue,
    "/api/jobs": _jobs,
}
POST: Final[Mapping[str, Callable[[Site, Mapping[str, Any]], Answer]]] = {
    "/api/validate": _validate,
    "/api/yaml": _yaml,
    "/api/preset": _preset,
    "/api/jobs": _start,
    "/api/jobs/cancel": _cancel,
}
