"""What ncsim-saga brings."""

from collections.abc import Iterable

from ncsim_core.plugins import Component, hookimpl

from ncsim_saga.catalogue import SCHEDULERS, CatalogueEntry

NCSIM_PLUGIN_API = "1.0"


@hookimpl
def ncsim_components() -> Iterable[Component]:
    """Return one scheduler per entry of the catalogue."""
    return [_component(entry) for entry in SCHEDULERS.values()]


def _component(entry: CatalogueEntry) -> Component:
    """Return the declaration of one scheduler.

    Schedulers with options have factories of their own, whose signatures say the defaults.
    """
    return Component(
        kind="scheduler",
        name=entry.name,
        factory=entry.factory,
        summary=f"{entry.summary} (SAGA)",
        options=_schema(entry),
        params={} if entry.options else {"name": entry.name},
        requires=entry.requires,
        capabilities=entry.capabilities,
        source=entry.source,
        expected_failures=entry.expected_failures,
    )


def _schema(entry: CatalogueEntry) -> dict[str, object] | None:
    if not entry.options:
        return None
    return {"type": "object", "properties": dict(entry.options), "additionalProperties": False}
