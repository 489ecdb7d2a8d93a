"""Where tasks run and what connects them: nodes, directed links, routes.

A ``Network`` is frozen. Inside ncsim nodes and links are dense integer indices in file order;
string ids appear only at the edges (files, traces, messages) and in tie-breaks.
"""

import math
from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, NewType, TypeAlias

from typing_extensions import override

from ncsim_core.errors import ScenarioError
from ncsim_core.units import MAX_QUANTITY, is_quantity

NodeId = NewType("NodeId", str)
LinkId = NewType("LinkId", str)
NodeIndex: TypeAlias = int
LinkIndex: TypeAlias = int

Route: TypeAlias = tuple[LinkIndex, ...]
"""Link indices in order from source to target; empty when both are the same node."""

Medium: TypeAlias = Literal["wireless", "wired"]


@dataclass(frozen=True, slots=True)
class Position:
    """A point in the plane, in metres."""

    x_m: float
    y_m: float


@dataclass(frozen=True, slots=True)
class Node:
    """A place where tasks run, one at a time.

    Args:
        id: Unique name.
        compute_capacity: Compute units per second, finite and greater than 0.
        position: Where the node's radio is, if it has one.
    """

    id: NodeId
    compute_capacity: float
    position: Position | None = None


@dataclass(frozen=True, slots=True)
class Link:
    """One directed hop.

    Args:
        id: Unique name.
        source: Id of the sending node.
        target: Id of the receiving node.
        bandwidth_MBps: Bandwidth given in the scenario; ``None`` leaves it to the link model.
        latency_s: Seconds paid once per transfer and hop, 0 or more.
        medium: ``wired`` takes the link out of every radio model.
    """

    id: LinkId
    source: NodeId
    target: NodeId
    bandwidth_MBps: float | None = None
    latency_s: float = 0.0
    medium: Medium = "wireless"


@dataclass(frozen=True)
class LinkRates:
    """What each link offers alone, in link order.

    Args:
        bandwidth_MBps: Clean solo goodput B of each link; 0 marks an unusable link.
        latency_s: Seconds from the end of a task to the first byte on the link.
    """

    bandwidth_MBps: tuple[float, ...]
    latency_s: tuple[float, ...]

    @classmethod
    def of(cls, bandwidth_MBps: Sequence[float], latency_s: Sequence[float]) -> "LinkRates":
        """Return rates from any sequences of numbers, numpy arrays included."""
        return cls(tuple(map(float, bandwidth_MBps)), tuple(map(float, latency_s)))


class Topology:
    """Nodes and links as a dictionary key whose hash is worked out once."""

    __slots__ = ("_hash", "links", "nodes")

    def __init__(self, nodes: tuple[Node, ...], links: tuple[Link, ...]) -> None:
        self.nodes = nodes
        self.links = links
        self._hash = hash((nodes, links))

    @override
    def __hash__(self) -> int:
        return self._hash

    @override
    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Topology):
            return NotImplemented
        return self is other or (self.nodes, self.links) == (other.nodes, other.links)


@dataclass(frozen=True)
class Network:
    """Nodes and directed links, with the clean rates once a link model has decided them.

    Raises:
        ScenarioError: An id is given twice, a link ends at an unknown node or where it
            began, or a number is negative, above ``MAX_QUANTITY`` or not a number.
    """

    nodes: tuple[Node, ...]
    links: tuple[Link, ...]
    rates: LinkRates | None = field(default=None, hash=False)

    def __post_init__(self) -> None:
        _check_nodes(self.nodes)
        _check_links(self.links, {node.id for node in self.nodes})

    @override
    def __hash__(self) -> int:
        return hash(self.topology)

    @cached_property
    def topology(self) -> "Topology":
        """Return what the network is apart from its rates, as a key that is hashed once."""
        return Topology(self.nodes, self.links)

    @cached_property
    def node_index(self) -> Mapping[NodeId, NodeIndex]:
        """Return the index of each node id."""
        return {node.id: index for index, node in enumerate(self.nodes)}

    @cached_property
    def link_index(self) -> Mapping[LinkId, LinkIndex]:
        """Return the index of each link id."""
        return {link.id: index for index, link in enumerate(self.links)}

    @cached_property
    def sources(self) -> tuple[NodeIndex, ...]:
        """Return the sending node of each link."""
        return tuple(self.node_index[link.source] for link in self.links)

    @cached_property
    def targets(self) -> tuple[NodeIndex, ...]:
        """Return the receiving node of each link."""
        return tuple(self.node_index[link.target] for link in self.links)

    @cached_property
    def outgoing(self) -> tuple[tuple[LinkIndex, ...], ...]:
        """Return for each node its outgoing links, ordered by link id as text."""
        leaving: list[list[LinkIndex]] = [[] for _ in self.nodes]
        for index in sorted(range(len(self.links)), key=lambda i: self.links[i].id):
            leaving[self.sources[index]].append(index)
        return tuple(tuple(links) for links in leaving)

    @property
    def bandwidth_MBps(self) -> tuple[float, ...]:
        """Return the clean solo goodput of each link; needs ``rates``."""
        return self._decided_rates.bandwidth_MBps

    @property
    def latency_s(self) -> tuple[float, ...]:
        """Return the latency of each link; needs ``rates``."""
        return self._decided_rates.latency_s

    @property
    def _decided_rates(self) -> LinkRates:
        if self.rates is None:
            raise ScenarioError(
                "this network has no link rates yet; ask a link model for them and use with_rates()"
            )
        return self.rates

    def with_rates(self, rates: LinkRates) -> "Network":
        """Return the same network with its clean link rates decided."""
        rated = copy(self)  # checked already; what follows from nodes and links comes along
        object.__setattr__(rated, "rates", rates)
        return rated

    def route_bottleneck_MBps(self, route: Route) -> float:
        """Return the least clean bandwidth on a route; infinite for the empty route."""
        bandwidth_MBps = self.bandwidth_MBps
        return min((bandwidth_MBps[link] for link in route), default=math.inf)

    def route_latency_s(self, route: Route) -> float:
        """Return the configured latency of a route, the sum over its links."""
        latency_s = self.latency_s
        return math.fsum(latency_s[link] for link in route)


def route_fault(
    route: Sequence[LinkIndex], source: NodeIndex, target: NodeIndex, network: Network
) -> str | None:
    """Return why ``route`` is no chain of usable links from source to target, or ``None``."""
    at, visited = source, {source}
    for link in route:
        if not 0 <= link < len(network.links):
            return f"link index {link!r} does not exist"
        name = network.links[link].id
        if network.sources[link] != at:
            return f"link {name!r} does not leave node {network.nodes[at].id!r}"
        if network.bandwidth_MBps[link] <= 0:
            return f"link {name!r} has no bandwidth"
        at = network.targets[link]
        if at in visited:
            return f"node {network.nodes[at].id!r} is visited twice"
        visited.add(at)
    if at != target:
        return f"it ends at {network.nodes[at].id!r} instead of {network.nodes[target].id!r}"
    return None


def _check_nodes(nodes: tuple[Node, ...]) -> None:
    seen: set[str] = set()
    for node in nodes:
        if node.id in seen:
            raise ScenarioError(f"node {node.id!r} is given twice; node ids must be unique")
        seen.add(node.id)
        if not (is_quantity(node.compute_capacity) and node.compute_capacity > 0):
            raise ScenarioError(
                f"node {node.id!r}: compute_capacity must be greater than 0 and "
                f"at most {MAX_QUANTITY:g}, not {node.compute_capacity!r}"
            )


def _check_links(links: tuple[Link, ...], node_ids: set[NodeId]) -> None:
    seen: set[str] = set()
    for link in links:
        if link.id in seen:
            raise ScenarioError(f"link {link.id!r} is given twice; link ids must be unique")
        seen.add(link.id)
        for end in (link.source, link.target):
            if end not in node_ids:
                raise ScenarioError(f"link {link.id!r} ends at unknown node {end!r}")
        if link.source == link.target:
            raise ScenarioError(f"link {link.id!r} leads from node {link.source!r} to itself")
        for name, value in (("bandwidth", link.bandwidth_MBps), ("latency", link.latency_s)):
            if value is not None and not is_quantity(value):
                raise ScenarioError(
                    f"link {link.id!r}: {name} must be from 0 to {MAX_QUANTITY:g}, not {value!r}"
                )
