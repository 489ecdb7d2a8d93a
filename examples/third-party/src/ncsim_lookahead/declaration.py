"""What ncsim-lookahead brings; read without importing the code behind it."""

from collections.abc import Iterable

from ncsim_core.plugins import Component, hookimpl

NCSIM_PLUGIN_API = "1.0"


@hookimpl
def ncsim_components() -> Iterable[Component]:
    """Return the components of this package."""
    return [
        Component(
            kind="scheduler",
            name="lookahead",
            factory="ncsim_lookahead.schedulers:Lookahead",
            summary="Earliest finish of a task and of its next, hops counted.",
            options={
                "type": "object",
                "additionalProperties": False,
                "properties": {
                    "hop_weight": {
                        "type": "number",
                        "minimum": 0,
                        "default": 1.0,
                        "description": "What each hop after the first adds to the planned time "
                        "of a transfer, as a part of the time it takes alone.",
                    },
                },
            },
        ),
    ]
