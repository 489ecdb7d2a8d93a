"""Static shadowing: one draw per pair of nodes, held for the run."""

import hashlib
import math
from collections.abc import Sequence

import numpy as np

from ncsim_wifi.quantities import FloatArray

_TWO_TO_53 = 2.0**53


def pair_draw(seed: int, one: str, other: str) -> float:
    """Return a standard normal number for an unordered pair of node ids.

    The pair's own stream is keyed by the seed and the two ids in text order, so that no
    other node or link of the scenario can change the draw. Box-Muller on two uniforms of 53 bits
    from SHA-256 needs no generator state and gives the same number on every platform.

    Source: SPEC 3.

    >>> pair_draw(42, "n1", "n0") == pair_draw(42, "n0", "n1")
    True
    """
    low, high = sorted((one, other))
    key = f"{seed}\x00{len(low)}\x00{low}\x00{high}".encode()
    digest = hashlib.sha256(key).digest()
    radius_uniform = ((int.from_bytes(digest[:8], "big") >> 11) + 1) / _TWO_TO_53
    angle_uniform = (int.from_bytes(digest[8:16], "big") >> 11) / _TWO_TO_53
    return math.sqrt(-2.0 * math.log(radius_uniform)) * math.cos(2.0 * math.pi * angle_uniform)


def shadowing_dB(node_ids: Sequence[str], sigma_dB: float, seed: int) -> FloatArray:
    """Return the extra loss between any two nodes, symmetric, 0 on the diagonal.

    Args:
        node_ids: Ids in matrix order.
        sigma_dB: Standard deviation of the normal distribution; its mean is 0.
        seed: The run's seed.
    """
    loss_dB = np.zeros((len(node_ids), len(node_ids)))
    if sigma_dB > 0:
        for row, one in enumerate(node_ids):
            for column in range(row):
                loss_dB[row, column] = sigma_dB * pair_draw(seed, one, node_ids[column])
        loss_dB += loss_dB.T
    return loss_dB
