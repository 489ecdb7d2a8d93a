"""Which package brings which well-known name: the only place where core names plug-in packages.

It serves error messages alone: ``pip install`` hints, and who owns a section.
"""

from collections.abc import Mapping
from typing import Final

PROVIDER_BY_NAME: Final[Mapping[str, Mapping[str, str]]] = {
    "scheduler": dict.fromkeys(
        (
            *("bil", "brute_force", "cpop", "dps", "duplex", "etf"),
            *("fastest_node", "fcp", "flb", "gdl", "hbmct", "heft", "maxmin", "mct"),
            *("met", "minmin", "msbc", "mst", "olb", "peft", "smt", "sufferage", "wba"),
        ),
        "ncsim-saga",
    )
    | dict.fromkeys(("conflict_aware_heft", "uniform_discount_heft"), "ncsim-wifi"),
    "routing_model": dict.fromkeys(
        ("widest_path", "minimum_hop", "shortest_path"), "ncsim-routing"
    ),
    "link_model": {"wifi": "ncsim-wifi"},
    "interference_model": dict.fromkeys(
        ("csma_bianchi", "csma_clique", "csma_spatial", "proximity"), "ncsim-wifi"
    ),
    "section": {"rf": "ncsim-wifi"},
}
"""Distribution of each well-known component, by kind and name; sections under ``section``."""

PROVIDER_OF_VERB: Final[Mapping[str, str]] = {"view": "ncsim-viz", "validate-model": "ncsim-wifi"}
"""Distribution of each well-known verb that is not ncsim-core's."""


def provider(kind: str, name: str) -> str | None:
    """Return the distribution known to bring a component or section, if any."""
    return PROVIDER_BY_NAME.get(kind, {}).get(name)
