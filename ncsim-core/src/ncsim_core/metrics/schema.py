"""The JSON Schema of ``metrics.json``."""

from collections.abc import Mapping
from typing import Final

from ncsim_core.metrics.summary import METRICS_FORMAT, METRICS_VERSION

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"

_NUMBER: Final = {"type": "number", "minimum": 0}
_NUMBER_OR_NULL: Final = {"type": ["number", "null"], "minimum": 0}
_COUNT: Final = {"type": "integer", "minimum": 0}
_TEXT: Final = {"type": "string"}


def metrics_schema() -> dict[str, object]:
    """Return the JSON Schema of a run's metrics."""
    properties = {
        "format": {"const": METRICS_FORMAT},
        "version": {"type": "string", "pattern": rf"^{METRICS_VERSION.partition('.')[0]}\.[0-9]+$"},
        "status": _TEXT | _said("How the run ended; truncated if its trace does not say."),
        "makespan_s": _NUMBER_OR_NULL
        | _said("When the last task ended, from time 0; null unless the run completed."),
        "ended_s": _NUMBER | _said("Time of the last event."),
        "events": _COUNT | _said("Events handled."),
        "tasks": _ended_of_total() | _said("Tasks of all DAGs that entered."),
        "transfers": _ended_of_total() | _said("Dependencies between two nodes."),
        "remote_MB": _NUMBER | _said("Payload of all dependencies between two nodes."),
        "route_work_MB_hops": _NUMBER
        | _said("Payload times links of its route, over all transfers that began."),
        "critical_path_s": _NUMBER_OR_NULL
        | _said("Lower bound: same placement and routes, no waiting, every transfer alone."),
        "mean_transfer_slowdown": _NUMBER_OR_NULL
        | _said("Time of byte service over that on an idle route, mean over ended transfers."),
        "max_transfer_slowdown": _NUMBER_OR_NULL | _said("The same, maximum."),
        "dags": _rows(
            id=_TEXT, injected_s=_NUMBER, ended_s=_NUMBER_OR_NULL, response_s=_NUMBER_OR_NULL
        ),
        "nodes": _rows(
            id=_TEXT, tasks_ended=_COUNT, busy_s=_NUMBER, utilisation=_NUMBER, queue_wait_s=_NUMBER
        ),
        "links": _rows(
            id=_TEXT, transfers=_COUNT, served_MB=_NUMBER, busy_s=_NUMBER, utilisation=_NUMBER
        ),
    }
    return {"$schema": DIALECT, "title": "Metrics of one ncsim run"} | _object(properties)


def _said(text: str) -> dict[str, object]:
    return {"description": text}


def _object(properties: Mapping[str, object]) -> dict[str, object]:
    return {"type": "object", "properties": dict(properties), "required": list(properties)}


def _ended_of_total() -> dict[str, object]:
    return _object({"total": _COUNT, "ended": _COUNT})


def _rows(**columns: Mapping[str, object]) -> dict[str, object]:
    return {"type": "array", "items": _object(columns)}
