"""Names -> components: finds plug-ins, keeps a broken one from harming the rest, builds by name.

    registry = get_registry()
    scheduler, identity = registry.build("scheduler", "heft", {}, context)

Loading reads declarations only. Neither numpy nor jsonschema nor any plug-in's own code beyond its
declaration module is imported until a component is built.
"""

from functools import cache

from ncsim_core.registry.catalogue import Registry
from ncsim_core.registry.discovery import load_registry
from ncsim_core.registry.records import (
    OptionsSchema,
    PluginRecord,
    RegisteredComponent,
    RegisteredSection,
)

__all__ = [
    "OptionsSchema",
    "PluginRecord",
    "RegisteredComponent",
    "RegisteredSection",
    "Registry",
    "get_registry",
    "load_registry",
]


@cache
def get_registry() -> Registry:
    """Return this process's registry, loaded on first use; ``cache_clear()`` forgets it."""
    return load_registry()
