"""What ncsim-routing brings."""

from collections.abc import Iterable

from ncsim_core.plugins import Component, hookimpl

NCSIM_PLUGIN_API = "1.0"


@hookimpl
def ncsim_components() -> Iterable[Component]:
    """Return the components of this package."""
    return []
