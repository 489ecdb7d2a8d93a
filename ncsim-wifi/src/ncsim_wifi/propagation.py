"""Which nodes have a radio, and what each hears of each other."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from ncsim_core.context import BuildContext
from ncsim_core.errors import ScenarioError
from ncsim_core.network import Link, LinkIndex, Network
from ncsim_core.units import MEGABITS_PER_MEGABYTE

from ncsim_wifi.phy.mcs import phy_rate_Mbps, rate_table
from ncsim_wifi.phy.path_loss import distances_m, path_loss_dB, reference_loss_dB
from ncsim_wifi.phy.received_power import received_power_dBm, snr_dB
from ncsim_wifi.phy.shadowing import shadowing_dB
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.radio import Radio


@dataclass(frozen=True)
class Propagation:
    """What the radios of one network receive of each other.

    Args:
        power_dBm: Received power by (sending node, receiving node), symmetric; minus infinity
            where a node has no position.
        signal_dBm: Received power of each link at its own receiver.
        rate_Mbps: Clean PHY rate R of each link; that of a wired link has no meaning.
    """

    power_dBm: FloatArray
    signal_dBm: FloatArray
    rate_Mbps: FloatArray


def propagation(context: BuildContext, radio: Radio) -> Propagation:
    """Return what the radios of a network receive, worked out once per network and radio."""
    return context.cached(
        ("ncsim_wifi.propagation", radio, radio.draws_from(context.seed)),
        lambda: _propagation(context.network, radio, context.seed),
    )


def _propagation(network: Network, radio: Radio, seed: int) -> Propagation:
    power_dBm = power_matrix_dBm(network, radio, seed)
    signal_dBm = power_dBm[list(network.sources), list(network.targets)]
    return Propagation(power_dBm, signal_dBm, clean_rates_Mbps(network.links, signal_dBm, radio))


def power_matrix_dBm(network: Network, radio: Radio, seed: int) -> FloatArray:
    """Return the received power between any two nodes, shape (nodes, nodes).

    Source: Eqs. 2 and 3 (``eq:pathloss``, ``eq:rxpower``), shadowing added to the loss.
    """
    positions = [node.position for node in network.nodes]
    positions_m = np.array(
        [(np.nan, np.nan) if at is None else (at.x_m, at.y_m) for at in positions]
    ).reshape(len(positions), 2)
    loss_dB = path_loss_dB(
        distances_m(positions_m), reference_loss_dB(radio.freq_ghz), radio.path_loss_exponent
    )
    if radio.shadow_fading_sigma > 0:
        ids = [node.id for node in network.nodes]
        loss_dB = loss_dB + shadowing_dB(ids, radio.shadow_fading_sigma, seed)
    power_dBm = received_power_dBm(radio.tx_power_dBm, loss_dB)
    return np.where(np.isnan(power_dBm), -np.inf, power_dBm)


def clean_rates_Mbps(links: Sequence[Link], signal_dBm: FloatArray, radio: Radio) -> FloatArray:
    """Return the clean PHY rate of each link: from its SNR, or from its own bandwidth.

    A bandwidth written in the scenario is a clean PHY rate in MB/s.

    Source: Eq. 4 (``eq:mcs``); SPEC 8.
    """
    rates_Mbps = phy_rate_Mbps(snr_dB(signal_dBm, radio.noise_floor_dBm), rate_table(radio))
    for index, link in enumerate(links):
        if link.bandwidth_MBps is not None:
            rates_Mbps[index] = MEGABITS_PER_MEGABYTE * link.bandwidth_MBps
    return rates_Mbps


def is_on_air(link: Link) -> bool:
    """Return whether a link uses a radio at all."""
    return link.medium == "wireless"


def require_positions(network: Network, links: Sequence[LinkIndex], who: str) -> None:
    """Check that both ends of each of ``links`` have positions.

    Raises:
        ScenarioError: Some have not; all such links are named.
    """
    placed = {node.id for node in network.nodes if node.position is not None}
    faults = []
    for index in links:
        link = network.links[index]
        bare = [end for end in (link.source, link.target) if end not in placed]
        if bare:
            faults.append(f"{link.id!r} ({', '.join(map(repr, bare))})")
    if faults:
        raise ScenarioError(
            f"{who}: links whose ends have no position: {', '.join(faults)}; give these nodes a "
            "position {x, y} in metres, or mark the links medium: wired with a bandwidth in MB/s"
        )
