"""Which links does a transfer occupy?"""

from abc import ABC, abstractmethod
from collections.abc import Sequence

from ncsim_core.errors import NcsimError, PluginError, told
from ncsim_core.network import LinkIndex, Network, NodeIndex, Route, route_fault


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

        Override it when one search answers all targets; the answers must equal ``route``'s. They
        may be a sequence that puts each route together when it is asked for: most never are.
        """
        return [self.route(source, target, network) for target in range(len(network.nodes))]


class RouteTable:
    """The routes of one network under one model, worked out once per source, checked when used.

    Args:
        model: The routing model.
        network: A network whose rates are decided.
        label: How errors name the model.
    """

    def __init__(self, model: RoutingModel, network: Network, label: str | None = None) -> None:
        self._model = model
        self._network = network
        self._label = label or type(model).__name__
        self._rows: dict[NodeIndex, Sequence[Route | None]] = {}
        self._checked: dict[tuple[NodeIndex, NodeIndex], Route | None] = {}

    def route(self, source: NodeIndex, target: NodeIndex) -> Route | None:
        """Return the route between two nodes, ``None`` if there is none.

        Raises:
            PluginError: The model answered with something that is no route.
        """
        try:
            return self._checked[source, target]
        except KeyError:  # asked for the first time
            pass
        if source not in self._rows:
            self._rows[source] = self._row(source)
        route = self._checked_route(source, target, self._answer(source, target))
        self._checked[source, target] = route
        return route

    def _answer(self, source: NodeIndex, target: NodeIndex) -> Route | None:
        """Return the model's answer, which may be put together only now."""
        try:
            return self._rows[source][target]
        except NcsimError:
            raise
        except (Exception, SystemExit) as error:
            raise PluginError(f"{self._label} raised {told(error)}") from error

    def _row(self, source: NodeIndex) -> Sequence[Route | None]:
        """Return the model's answers for one source; they are checked when they are asked for."""
        try:
            answers = self._model.routes_from(source, self._network)
            count = len(answers)
        except NcsimError:
            raise
        except (Exception, SystemExit) as error:
            raise PluginError(f"{self._label} raised {told(error)}") from error
        if count != len(self._network.nodes):
            raise PluginError(
                f"{self._label}: routes_from() gave {count} routes "
                f"for {len(self._network.nodes)} nodes"
            )
        return answers

    def _checked_route(
        self, source: NodeIndex, target: NodeIndex, answer: Sequence[LinkIndex] | None
    ) -> Route | None:
        if answer is None:
            return None
        try:
            route = tuple(answer)
            fault = route_fault(route, source, target, self._network)
        except (TypeError, ValueError):
            fault = f"{answer!r} is no tuple of link indices"
        if fault:
            nodes = self._network.nodes
            ends = f"{nodes[source].id!r} to {nodes[target].id!r}"
            raise PluginError(f"{self._label}: the route from {ends} is wrong: {fault}")
        return route
