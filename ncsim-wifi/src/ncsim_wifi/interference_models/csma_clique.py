"""A static share of the channel by the largest clique of the conflict graph."""

from collections.abc import Collection, Sequence

import numpy as np
from ncsim_core.context import BuildContext
from ncsim_core.contracts.interference_model import InterferenceModel
from ncsim_core.network import LinkIndex
from typing_extensions import override

from ncsim_wifi.cliques import largest_clique_sizes
from ncsim_wifi.conflict import Relations, relations
from ncsim_wifi.propagation import is_on_air, require_positions
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.radio import Radio


def clique_sizes(related: Relations) -> list[int]:
    """Return for each link the size of the largest clique of the conflict graph around it."""
    return largest_clique_sizes(
        [
            sum(1 << other for other in related.conflicts(link).tolist())
            for link in range(related.link_count)
        ]
    )


class CsmaCliqueModel(InterferenceModel):
    """Gives a link 1/omega, omega being the largest set of links around it that conflict.

    The share counts every link of the clique, active or not: it is static, so a link that is
    alone does not get its whole bandwidth.

    Source: the published ncsim's ``csma_clique``.

    Args:
        context: Network and config section ``rf``.

    Raises:
        ScenarioError: Wireless links lack positions; all of them are named.
    """

    def __init__(self, context: BuildContext) -> None:
        radio = Radio.from_section(context.section("rf"))
        network = context.network
        on_air = [index for index, link in enumerate(network.links) if is_on_air(link)]
        require_positions(network, on_air, "interference csma_clique")
        self._sizes = context.cached(
            ("ncsim_wifi.csma_clique", radio, radio.draws_from(context.seed)),
            lambda: np.array(clique_sizes(relations(context, radio)), dtype=np.float64),
        )

    @override
    def factors(self, links: Sequence[LinkIndex], active: Collection[LinkIndex]) -> FloatArray:
        return 1.0 / self._sizes[list(links)]

    @override
    def reach(self, changed: Collection[LinkIndex]) -> Collection[LinkIndex]:
        return changed
