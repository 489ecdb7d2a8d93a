"""Sharing among links that are near each other, without any radio."""

from collections.abc import Collection, Sequence

import numpy as np
from ncsim_core.context import BuildContext
from ncsim_core.contracts.interference_model import Competition, InterferenceModel
from ncsim_core.network import LinkIndex, Network
from typing_extensions import override

from ncsim_wifi.propagation import is_on_air, require_positions
from ncsim_wifi.quantities import BoolArray, FloatArray


def midpoints_m(network: Network) -> FloatArray:
    """Return the point halfway between the ends of each link, shape (links, 2)."""
    nodes_m = np.array(
        [(np.nan, np.nan) if n.position is None else (n.position.x_m, n.position.y_m)
         for n in network.nodes]
    ).reshape(len(network.nodes), 2)  # fmt: skip
    sources, targets = list(network.sources), list(network.targets)
    between_m: FloatArray = (nodes_m[sources] + nodes_m[targets]) / 2.0
    return between_m


def near_links(network: Network, radius_m: float) -> BoolArray:
    """Return which wireless links have midpoints within a radius, shape (links, links)."""
    at_m = midpoints_m(network)
    apart_m = np.hypot(*(at_m[:, None, axis] - at_m[None, :, axis] for axis in (0, 1)))
    on_air = np.array([is_on_air(link) for link in network.links], np.bool_)
    is_near = (apart_m <= radius_m) & on_air[:, None] & on_air[None, :]
    np.fill_diagonal(is_near, val=True)
    return np.asarray(is_near, np.bool_)


class ProximityModel(InterferenceModel):
    """Gives a link 1/k when k active links, itself included, lie within a radius of it.

    A link lies where its midpoint is. Wired links are out of it.

    Source: the published ncsim's ``proximity``.

    Args:
        context: Network.
        radius: Greatest distance of midpoints in metres.

    Raises:
        ScenarioError: Wireless links lack positions; all of them are named.
    """

    def __init__(self, context: BuildContext, *, radius: float = 15.0) -> None:
        network = context.network
        on_air = [index for index, link in enumerate(network.links) if is_on_air(link)]
        require_positions(network, on_air, "interference proximity")
        self._is_near = context.cached(
            ("ncsim_wifi.proximity", radius), lambda: near_links(network, radius)
        )

    @override
    def factors(self, links: Sequence[LinkIndex], active: Collection[LinkIndex]) -> FloatArray:
        shares: FloatArray = 1.0 / self._crowd(links, active)
        return shares

    @override
    def reach(self, changed: Collection[LinkIndex]) -> Collection[LinkIndex]:
        reached: list[LinkIndex] = np.flatnonzero(self._is_near[list(changed)].any(axis=0)).tolist()
        return reached

    @override
    def competition(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> Sequence[Competition]:
        return [Competition(contenders=int(k) - 1) for k in self._crowd(links, active)]

    def _crowd(self, links: Sequence[LinkIndex], active: Collection[LinkIndex]) -> FloatArray:
        near = self._is_near[np.ix_(list(links), list(active))]
        crowd: FloatArray = near.sum(axis=1, dtype=np.float64)
        return crowd
