"""One suite per contract: subclass it in a test module and name your component."""

from collections.abc import Mapping
from typing import Final

from ncsim_core.testing.suites.base import ComponentSuite
from ncsim_core.testing.suites.dag_source import DAGSourceSuite
from ncsim_core.testing.suites.interference_model import InterferenceModelSuite
from ncsim_core.testing.suites.link_model import LinkModelSuite
from ncsim_core.testing.suites.plugin import PluginSuite
from ncsim_core.testing.suites.queue_model import QueueModelSuite
from ncsim_core.testing.suites.routing_model import RoutingModelSuite
from ncsim_core.testing.suites.scheduler import SchedulerSuite

SUITES: Final[Mapping[str, type[ComponentSuite]]] = {
    suite.kind: suite
    for suite in (
        SchedulerSuite,
        RoutingModelSuite,
        LinkModelSuite,
        InterferenceModelSuite,
        QueueModelSuite,
        DAGSourceSuite,
    )
}

__all__ = [
    "SUITES",
    "ComponentSuite",
    "DAGSourceSuite",
    "InterferenceModelSuite",
    "LinkModelSuite",
    "PluginSuite",
    "QueueModelSuite",
    "RoutingModelSuite",
    "SchedulerSuite",
]
