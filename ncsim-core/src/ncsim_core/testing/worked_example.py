"""The paper's worked example: a two-hop route, sharing, and FIFO compute; 5 s in all.

Source: the paper's Appendix B (``app:engine``), Table ``tab:worked_engine``.
"""

from ncsim_core.engine.observer import Watcher
from ncsim_core.engine.simulation import Simulation
from ncsim_core.network import Link, LinkId, LinkRates, Network, Node, NodeId
from ncsim_core.testing.toys import models
from ncsim_core.workflow import DAG, DagId, Dependency, Injection, Task, TaskId

MAKESPAN_us = 5_000_000
SERVED_MB = {"ab": 4.0, "bc": 5.0}

_A, _B, _C = NodeId("a"), NodeId("b"), NodeId("c")

NETWORK = Network(
    (Node(_A, 1.0), Node(_B, 1.0), Node(_C, 1.0)),
    (Link(LinkId("ab"), _A, _B, 2.0), Link(LinkId("bc"), _B, _C, 2.0)),
    LinkRates((2.0, 2.0), (0.0, 0.0)),
)
EXAMPLE = DAG(
    DagId("example"),
    (
        Task(TaskId("A"), 1.0, _A),
        Task(TaskId("B"), 2.0, _B),
        Task(TaskId("C"), 1.0, _C),
        Task(TaskId("D"), 1.0, _C),
    ),
    (Dependency(TaskId("A"), TaskId("C"), 4.0), Dependency(TaskId("B"), TaskId("D"), 1.0)),
)


def worked_example(*observers: Watcher) -> Simulation:
    """Return a simulation of the example that has not begun."""
    injections = [Injection(0, EXAMPLE)]
    return Simulation(NETWORK, models(NETWORK, injections), observers=observers)
