"""Static shadowing: one draw per pair of nodes, held for the run."""

import hashlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ncsim_wifi.quantities import FloatArray

SECOND_STREAM = np.uint64(0x9E3779B97F4A7C15)
_MIX_1, _MIX_2 = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)


def shadowing_dB(node_ids: Sequence[str], sigma_dB: float, seed: int) -> FloatArray:
    """Return the extra loss between any two nodes, symmetric, 0 on the diagonal.

    Source: Section III-B of the paper (static log-normal shadowing); SPEC 3.

    Args:
        node_ids: Ids in matrix order.
        sigma_dB: Standard deviation of the normal distribution; its mean is 0.
        seed: The run's seed.
    """
    if sigma_dB <= 0:
        return np.zeros((len(node_ids), len(node_ids)))
    loss_dB = sigma_dB * pair_draws(node_ids, seed)
    np.fill_diagonal(loss_dB, 0.0)
    return loss_dB


def pair_draws(node_ids: Sequence[str], seed: int) -> FloatArray:
    """Return a standard normal number for any two nodes, the same for both orders.

    Each pair has a stream of its own, keyed by the seed and the two ids, so that no other node
    or link of the scenario, and no order of listing, can change its draw. The key of a
    node is a hash of seed and id; sum and exclusive-or of two keys do not tell their order; mixed,
    they are two uniform numbers, and Box and Muller make them a normal one.
    """
    keys = np.array([_node_key(seed, node_id) for node_id in node_ids], dtype=np.uint64)
    one, other = keys[:, None], keys[None, :]
    radius = 1.0 - _uniform(_mixed(one + other))  # in (0, 1], so that its logarithm exists
    angle = _uniform(_mixed((one ^ other) + SECOND_STREAM))
    draws: FloatArray = np.sqrt(-2.0 * np.log(radius)) * np.cos(2.0 * np.pi * angle)
    return draws


def _node_key(seed: int, node_id: str) -> int:
    digest = hashlib.sha256(f"{seed}\x00{node_id}".encode("utf-8", "surrogatepass")).digest()
    return int.from_bytes(digest[:8], "big")


def _mixed(bits: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return well-mixed bits: the finaliser of SplitMix64 (Steele, Lea and Flood, 2014)."""
    bits = (bits ^ (bits >> np.uint64(30))) * _MIX_1
    bits = (bits ^ (bits >> np.uint64(27))) * _MIX_2
    return bits ^ (bits >> np.uint64(31))


def _uniform(bits: NDArray[np.uint64]) -> FloatArray:
    """Return numbers in [0, 1) from the upper 53 bits."""
    return (bits >> np.uint64(11)).astype(np.float64) * 2.0**-53
