"""What ncsim-routing brings."""

from collections.abc import Iterable

from ncsim_core.plugins import Component, hookimpl

NCSIM_PLUGIN_API = "1.0"


@hookimpl
def ncsim_components() -> Iterable[Component]:
    """Return the three routing models that search."""
    return [
        Component(
            kind="routing_model",
            name="widest_path",
            factory="ncsim_routing.routing_models.widest_path:WidestPathRouting",
            summary="Maximises the least clean bandwidth along the route.",
            capabilities=frozenset({"objective=bottleneck", "pure"}),
            source="Section IV-E, WidestPath",
        ),
        Component(
            kind="routing_model",
            name="minimum_hop",
            factory="ncsim_routing.routing_models.minimum_hop:MinimumHopRouting",
            summary="Takes the fewest links.",
            capabilities=frozenset({"objective=hops", "pure"}),
            source="Section IV-E, MinimumHop",
        ),
        Component(
            kind="routing_model",
            name="shortest_path",
            factory="ncsim_routing.routing_models.shortest_path:ShortestPathRouting",
            summary="Minimises the sum of configured latencies.",
            capabilities=frozenset({"objective=latency", "pure"}),
            source="Section IV-E, ShortestPath",
        ),
    ]
