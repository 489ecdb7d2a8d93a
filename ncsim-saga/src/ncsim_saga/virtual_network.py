"""The network as SAGA's schedulers see it: one virtual link between every two nodes.

Source: Section IV-D of the paper; SPEC 21.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from weakref import WeakKeyDictionary

from ncsim_core.contracts.routing_model import RouteTable
from ncsim_core.contracts.scheduler import NetworkSnapshot

UNREACHABLE_MBps = 0.001  # SPEC 21: discourages a pair without a route, but lets SAGA plan
SAME_NODE_MBps = 10_000.0  # SPEC 21: data that stays on its node


@dataclass(frozen=True, eq=False)
class VirtualNetwork:
    """Capacities, and a speed for every ordered pair of nodes, by node index.

    Args:
        capacities: Compute units per second of each node.
        speed_MBps: Row by row, from each node to each node.
    """

    capacities: tuple[float, ...]
    speed_MBps: tuple[tuple[float, ...], ...]

    def __len__(self) -> int:
        return len(self.capacities)


_known: WeakKeyDictionary[RouteTable, VirtualNetwork] = WeakKeyDictionary()


def virtual_network(snapshot: NetworkSnapshot) -> VirtualNetwork:
    """Return what SAGA sees of a snapshot, worked out once per table of routes."""
    known = _known.get(snapshot.routes)
    if known is None:
        known = _known[snapshot.routes] = _from_routes(snapshot)
    return known


def node_name(index: int) -> str:
    """Return the name of a node in SAGA's network.

    Names decide SAGA's ties, so they do not follow the user's ids: renaming a node changes no
    plan.
    """
    return f"n{index}"


def _from_routes(snapshot: NetworkSnapshot) -> VirtualNetwork:
    everyone = range(len(snapshot.network.nodes))
    return VirtualNetwork(
        tuple(node.compute_capacity for node in snapshot.network.nodes),
        tuple(_speeds_from(source, everyone, snapshot) for source in everyone),
    )


def _speeds_from(
    source: int, targets: Sequence[int], snapshot: NetworkSnapshot
) -> tuple[float, ...]:
    bandwidth_MBps = snapshot.network.bandwidth_MBps
    speeds_MBps = []
    for target in targets:
        route = snapshot.routes.route(source, target)
        if route is None:
            speeds_MBps.append(UNREACHABLE_MBps)
        elif source == target:
            speeds_MBps.append(SAME_NODE_MBps)
        else:
            speeds_MBps.append(min(map(bandwidth_MBps.__getitem__, route)))
    return tuple(speeds_MBps)
