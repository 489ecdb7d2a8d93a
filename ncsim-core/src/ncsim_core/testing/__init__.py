"""For authors of plug-ins: is my component what its contract promises?

The shortest test file there is, for a scheduler registered as ``mine``::

    from ncsim_core.testing import SchedulerSuite

    class TestMine(SchedulerSuite):
        component = "mine"

Needs the extra ``ncsim-core[testing]`` (pytest and hypothesis); ``builders`` needs neither.
"""

import importlib
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ncsim_core.testing.checking import check_component
    from ncsim_core.testing.results import CheckResult
    from ncsim_core.testing.suites import (
        ComponentSuite,
        DAGSourceSuite,
        InterferenceModelSuite,
        LinkModelSuite,
        PluginSuite,
        QueueModelSuite,
        RoutingModelSuite,
        SchedulerSuite,
    )

__all__ = [
    "CheckResult",
    "ComponentSuite",
    "DAGSourceSuite",
    "InterferenceModelSuite",
    "LinkModelSuite",
    "PluginSuite",
    "QueueModelSuite",
    "RoutingModelSuite",
    "SchedulerSuite",
    "check_component",
]

_HOME = {
    "CheckResult": "ncsim_core.testing.results",
    "check_component": "ncsim_core.testing.checking",
}

if sys.modules.get("pytest"):  # lets pytest explain the assertions of the suites
    sys.modules["pytest"].register_assert_rewrite("ncsim_core.testing.suites")


def __getattr__(name: str) -> object:
    """Import a public name when it is asked for, so that ``builders`` costs nothing else."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = _HOME.get(name, "ncsim_core.testing.suites")
    return getattr(importlib.import_module(home), name)
