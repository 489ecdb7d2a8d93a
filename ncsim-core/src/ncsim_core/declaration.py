"""What ncsim-core itself brings: the plainest component of each kind."""

from collections.abc import Iterable

from ncsim_core.plugins import Component, hookimpl

NCSIM_PLUGIN_API = "1.0"


@hookimpl
def ncsim_components() -> Iterable[Component]:
    """Return the built-in components."""
    return [
        Component(
            kind="scheduler",
            name="manual",
            factory="ncsim_core.builtin.schedulers:ManualScheduler",
            summary="Places every task where pinned_to says.",
        ),
        Component(
            kind="scheduler",
            name="round_robin",
            factory="ncsim_core.builtin.schedulers:RoundRobinScheduler",
            summary="Deals unpinned tasks out to the nodes in turn, in file order.",
            capabilities=frozenset({"scale_invariant"}),
        ),
        Component(
            kind="scheduler",
            name="all_on_fastest",
            factory="ncsim_core.builtin.schedulers:AllOnFastestScheduler",
            summary="Puts every task on the fastest node, so that nothing is sent.",
            capabilities=frozenset({"scale_invariant"}),
        ),
        Component(
            kind="routing_model",
            name="direct",
            factory="ncsim_core.builtin.routing_models:DirectRouting",
            summary="Takes the one link from source to target; no multi-hop routes.",
            capabilities=frozenset({"single_hop", "pure"}),
        ),
        Component(
            kind="link_model",
            name="static",
            factory="ncsim_core.builtin.link_models:StaticLinkModel",
            summary="Gives each link the bandwidth written in the scenario.",
        ),
        Component(
            kind="interference_model",
            name="none",
            factory="ncsim_core.builtin.interference_models:NoInterference",
            summary="No interference; transfers on one link still share it.",
            capabilities=frozenset({"monotone"}),
        ),
        Component(
            kind="queue_model",
            name="fifo",
            factory="ncsim_core.builtin.queue_models:FifoQueue",
            summary="First in, first out.",
            capabilities=frozenset({"order=fifo"}),
        ),
        Component(
            kind="dag_source",
            name="single",
            factory="ncsim_core.builtin.dag_sources:SingleDAGSource",
            summary="Injects the scenario's only DAG.",
        ),
        Component(
            kind="dag_source",
            name="multi",
            factory="ncsim_core.builtin.dag_sources:MultiDAGSource",
            summary="Injects every DAG of the scenario at its inject_at.",
        ),
    ]
