"""What each of a set of links delivers when all always have something to send."""

from collections.abc import Sequence

import numpy as np

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.forms import form_for
from ncsim_wifi.spatial.plant import Plant
from ncsim_wifi.spatial.scene import scene_of


def saturated_goodputs_MBps(plant: Plant, links: Sequence[int]) -> FloatArray:
    """Return what each of a set of links delivers when all always have something to send.

    Args:
        plant: All links of the network.
        links: The active ones, each once; their order has no influence.
    """
    if not links:
        return np.zeros(0)
    in_order = plant.in_order(links)
    solver = form_for(plant.settings.approximations.iterations, len(links))
    solved = solver(scene_of(plant, in_order)).goodputs_MBps()
    by_link = dict(zip(in_order, solved.tolist(), strict=True))
    return np.array([by_link[link] for link in links])
