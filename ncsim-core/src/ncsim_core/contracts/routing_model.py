"""Which links does a transfer occupy?"""

from abc import ABC, abstractmethod
from collections.abc import Sequence

from ncsim_core.errors import NcsimError, PluginError
from ncsim_core.network import Network, NodeIndex, Route, route_fault


class RoutingModel(ABC):
    """Chooses the chain of links between two nodes from clean bandwidths and latencies."""

    @abstractmethod
    def route(self, source: NodeIndex, target: NodeIndex, network: Network) -> Route | None:
        """Return the links from source to target in order, or ``None`` if there is no way.

        The route visits no node twice and uses links with bandwidth above 0 only. It is empty
        when source and target are the same node. Ties must not depend on the order in
        which links are listed: break them on ids, compared as text.
        """

    def routes_from(self, source: NodeIndex, network: Network) -> Sequence[Route | None]:
        """Return the routes from one node to every node, in node order.

        Override it when one search answers all targets; the answers must equal ``route``'s.
        """
        return [self.route(source, target, network) for target in range(len(network.nodes))]


class RouteTable:
    """The routes of one network under one model, worked out once per source and checked.

    Args:
        model: The routing model.
        network: A network whose rates are decided.
        label: How errors name the model.
    """

    def __init__(self, model: RoutingModel, network: Network, label: str | None = None) -> None:
        self._model = model
        self._network = network
        self._label = label or type(model).__name__
        self._rows: dict[NodeIndex, tuple[Route | None, ...]] = {}

    def route(self, source: NodeIndex, target: NodeIndex) -> Route | None:
        """Return the route between two nodes, ``None`` if there is none.

        Raises:
            PluginError: The model answered with something that is no route.
        """
        row = self._rows.get(source)
        if row is None:
            row = self._rows[source] = self._checked_row(source)
        return row[target]

    def _checked_row(self, source: NodeIndex) -> tuple[Route | None, ...]:
        network = self._network
        try:
            answers = self._model.routes_from(source, network)
        except NcsimError:
            raise
        except Exception as error:
            raise PluginError(f"{self._label} raised {type(error).__name__}: {error}") from error
        if len(answers) != len(network.nodes):
            raise PluginError(
                f"{self._label}: routes_from() gave {len(answers)} routes "
                f"for {len(network.nodes)} nodes"
            )
        row = tuple(None if route is None else tuple(route) for route in answers)
        for target, route in enumerate(row):
            fault = None if route is None else route_fault(route, source, target, network)
            if fault:
                ends = f"{network.nodes[source].id!r} to {network.nodes[target].id!r}"
                raise PluginError(f"{self._label}: the route from {ends} is wrong: {fault}")
        return row
