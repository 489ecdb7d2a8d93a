"""Bandwidths and factors under all options of ``rf`` and of the model, against plain formulas.

The formulas are written out here as the paper has them, in floating point and decibels, link by
link; nodes may stand on each other, have no place at all, or be joined by wires.
"""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from ncsim_core.network import Link, LinkId, Network, Node, NodeId, Position
from ncsim_core.testing.builders import make_context
from ncsim_wifi.interference_models.csma_bianchi import csma_bianchi
from ncsim_wifi.link_models.wifi import WifiLinkModel
from ncsim_wifi.phy.mcs import read_table
from ncsim_wifi.phy.shadowing import shadowing_dB
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation.literal_mac import goodput_Mbps

CLOSE_dB = 1e-5  # what is this near a threshold may fall on either side

RADIOS = st.builds(
    Radio,
    tx_power_dBm=st.sampled_from([0.0, 20.0, 30.0]),
    freq_ghz=st.sampled_from([2.4, 5.0]),
    path_loss_exponent=st.sampled_from([2.0, 3.0, 4.5]),
    noise_floor_dBm=st.sampled_from([-95.0, -90.0]),
    cca_threshold_dBm=st.sampled_from([-82.0, -62.0]),
    channel_width_mhz=st.sampled_from([20, 40, 80, 160]),
    wifi_standard=st.sampled_from(["n", "ac", "ax"]),
    shadow_fading_sigma=st.sampled_from([0.0, 0.0, 6.0, 40.0]),
    rts_cts=st.booleans(),
    capture_margin_dB=st.sampled_from([0.0, 5.0, 12.0]),
    interference_cutoff_dBm=st.sampled_from([-105.0, -80.0]),
)
OPTIONS = st.fixed_dictionaries(
    {},
    optional={
        "components": st.sampled_from(["combined", "contention_only", "hidden_only"]),
        "outage_floor_factor": st.sampled_from([0.02, 0.7]),
    },
)
COORDINATES = st.sampled_from([0.0, 0.4, 30.0, 77.0, 150.0, 320.0])
PLACES = st.none() | st.builds(Position, COORDINATES, COORDINATES)
BANDWIDTHS = st.none() | st.sampled_from([0.8, 8.6, 300.0])


@st.composite
def networks(draw):
    places = draw(st.lists(PLACES, min_size=2, max_size=8))
    nodes = tuple(Node(NodeId(f"n{i}"), 1.0, at) for i, at in enumerate(places))
    pairs = st.tuples(st.integers(0, len(nodes) - 1), st.integers(1, len(nodes) - 1))
    links = []
    for i, (source, step) in enumerate(draw(st.lists(pairs, min_size=1, max_size=9))):
        ends = nodes[source], nodes[(source + step) % len(nodes)]
        is_placed = None not in (ends[0].position, ends[1].position)
        rate_MBps, medium = (draw(BANDWIDTHS), "wireless") if is_placed else (3.0, "wired")
        links.append(Link(LinkId(f"l{i}"), ends[0].id, ends[1].id, rate_MBps, 0.0, medium))
    return Network(nodes, tuple(links))


class Literal:
    """The paper's formulas for one network."""

    def __init__(self, network, radio, seed):
        self.radio, self.nodes = radio, {node.id: node for node in network.nodes}
        ids = list(self.nodes)
        drawn = shadowing_dB(ids, radio.shadow_fading_sigma, seed)
        self.extra_dB = {(a, b): drawn[i][j] for i, a in enumerate(ids) for j, b in enumerate(ids)}

    def power_dBm(self, source, target):
        if source == target:
            return math.inf
        a, b = self.nodes[source].position, self.nodes[target].position
        if a is None or b is None:
            return -math.inf
        apart_m = max(1.0, math.hypot(a.x_m - b.x_m, a.y_m - b.y_m))
        friis_dB = 20.0 * math.log10(4.0 * math.pi * self.radio.freq_ghz * 1e9 / 3e8)
        spread_dB = 10.0 * self.radio.path_loss_exponent * math.log10(apart_m)
        return self.radio.tx_power_dBm - friis_dB - spread_dB - self.extra_dB[source, target]

    def reaches(self, level, threshold):
        assume(abs(level - threshold) > CLOSE_dB)
        return level > threshold

    def rate_Mbps(self, ratio_dB, margin_dB):
        table = read_table(self.radio.wifi_standard)
        scale = self.radio.channel_width_mhz / 20
        met = [
            rate * scale
            for threshold_dB, rate in zip(table.snr_min_dB, table.rate_Mbps, strict=True)
            if self.reaches(ratio_dB, threshold_dB - margin_dB)
        ]
        return max(met, default=0.0)

    def clean_Mbps(self, link):
        if link.bandwidth_MBps is not None:
            return 8.0 * link.bandwidth_MBps
        signal_dBm = self.power_dBm(link.source, link.target)
        return self.rate_Mbps(signal_dBm - self.radio.noise_floor_dBm, 0.0)

    def conflict(self, one, other):
        if {one.source, one.target} & {other.source, other.target}:
            return True
        pairs = [(one.source, other.source), (one.source, other.target), (one.target, other.source)]
        pairs += [(one.target, other.target)] * self.radio.rts_cts
        return any(
            self.reaches(self.power_dBm(a, b), self.radio.cca_threshold_dBm) for a, b in pairs
        )

    def effective_Mbps(self, link, hidden):
        powers_dBm = [self.power_dBm(other.source, link.target) for other in hidden]
        heard = [p for p in powers_dBm if self.reaches(p, self.radio.interference_cutoff_dBm)]
        if not heard:
            return self.clean_Mbps(link)
        unwanted_mW = sum(10.0 ** (p / 10.0) for p in [self.radio.noise_floor_dBm, *heard])
        ratio_dB = self.power_dBm(link.source, link.target) - 10.0 * math.log10(unwanted_mW)
        margin_dB = self.radio.capture_margin_dB
        return min(self.clean_Mbps(link), self.rate_Mbps(ratio_dB, margin_dB))

    def goodput_Mbps(self, stations, rate_Mbps):
        if rate_Mbps == 0.0:
            return 0.0
        return goodput_Mbps(stations, rate_Mbps, rts_cts=self.radio.rts_cts)

    def bandwidth_MBps(self, link):
        if link.medium == "wired":
            return link.bandwidth_MBps
        return self.goodput_Mbps(1, self.clean_Mbps(link)) / 8.0

    def factor(self, link, active, components="combined", outage_floor_factor=0.0):
        if link.medium == "wired":
            return 1.0
        others = [each for each in active if each is not link and each.medium == "wireless"]
        hidden = [each for each in others if not self.conflict(link, each)]
        contenders = len(others) - len(hidden)
        if components == "contention_only":
            hidden = []
        if components == "hidden_only":
            contenders = 0
        served_Mbps = self.goodput_Mbps(1 + contenders, self.effective_Mbps(link, hidden))
        alone_Mbps = self.goodput_Mbps(1, self.clean_Mbps(link))
        return max(served_Mbps / (1 + contenders) / alone_Mbps, outage_floor_factor)


@settings(max_examples=150)
@given(networks(), RADIOS, OPTIONS, st.integers(0, 50), st.sets(st.integers(0, 8)))
def test_bandwidths_and_factors_are_those_of_the_plain_formulas(
    network, radio, options, seed, chosen
):
    context = make_context(network, seed=seed, sections={"rf": vars(radio)})
    literal = Literal(network, radio, seed)
    bandwidths_MBps = WifiLinkModel(context).rate_links(network).bandwidth_MBps
    active = [i for i, rate in enumerate(bandwidths_MBps) if i in chosen and rate > 0.0]

    factors = csma_bianchi(context, **options).factors(active, active)

    expected_MBps = [literal.bandwidth_MBps(link) for link in network.links]
    assert bandwidths_MBps == pytest.approx(expected_MBps, rel=1e-12)
    links = [network.links[i] for i in active]
    expected = [literal.factor(link, links, **options) for link in links]
    assert factors.tolist() == pytest.approx(expected, rel=1e-12)
