"""Makes scenarios in Python instead of reading them."""

from collections.abc import Iterable, Mapping

from ncsim_core.network import Network
from ncsim_core.registry import Registry
from ncsim_core.scenario.loader import parse_scenario
from ncsim_core.scenario.model import Scenario, dag_row, link_row, node_row
from ncsim_core.workflow import DAG, Injection


def make_scenario(
    name: str,
    network: Network,
    dags: Iterable[DAG | Injection],
    config: Mapping[str, object] | None = None,
    *,
    registry: Registry | None = None,
) -> Scenario:
    """Return a scenario made of objects, checked as a file would be.

    Args:
        name: What people call it.
        network: Nodes and links.
        dags: DAGs, injected at 0 unless they come as injections.
        config: What would stand under ``config`` in a file.
        registry: Where components are looked up; by default whatever is installed.

    Raises:
        ScenarioError: All faults are listed.
    """
    injections = [each if isinstance(each, Injection) else Injection(0, each) for each in dags]
    document = {
        "name": name,
        "network": {
            "nodes": [node_row(node) for node in network.nodes],
            "links": [link_row(link) for link in network.links],
        },
        "dags": [dag_row(injection) for injection in injections],
        "config": dict(config or {}),
    }
    return parse_scenario({"scenario": document}, name=name, registry=registry)
