from dataclasses import replace

import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.network import LinkId, Network
from ncsim_core.testing.builders import line, make_context, network_of, node
from ncsim_wifi.link_models.wifi import WifiLinkModel
from ncsim_wifi.validation.scenes import single


def rates_MBps(network, rate="solo", **rf):
    context = make_context(network, sections={"rf": rf})
    return list(WifiLinkModel(context, rate=rate).rate_links(network).bandwidth_MBps)


def thirty_metres():
    return single(30.0).network()


def test_solo_counts_the_overhead_and_raw_phy_does_not():
    assert rates_MBps(thirty_metres()) == pytest.approx([3.783], abs=5e-4)
    assert rates_MBps(thirty_metres(), "raw_phy") == [8.6]


def test_a_written_bandwidth_is_a_clean_phy_rate():
    network = line(2, bandwidth_MBps=8.6)

    assert rates_MBps(network) == pytest.approx([3.783, 3.783], abs=5e-4)
    assert rates_MBps(network, "raw_phy") == [8.6, 8.6]


def test_a_wired_link_keeps_its_bandwidth():
    links = tuple(replace(each, medium="wired") for each in line(2, bandwidth_MBps=8.6).links)
    network = Network((node(0), node(1)), links)

    assert rates_MBps(network) == [8.6, 8.6]


def test_a_wired_link_needs_a_bandwidth():
    links = tuple(replace(each, medium="wired") for each in line(2, bandwidth_MBps=None).links)

    with pytest.raises(ScenarioError, match="wired links without bandwidth: 'n0_n1', 'n1_n0'"):
        rates_MBps(Network((node(0), node(1)), links))


def test_all_links_without_positions_are_named_with_the_remedy():
    bare = line(3, bandwidth_MBps=None)
    network = Network((bare.nodes[0], node(1), node(2)), bare.links)

    with pytest.raises(ScenarioError) as caught:
        rates_MBps(network)

    message = str(caught.value)
    for link in bare.links:
        assert repr(str(link.id)) in message
    assert "'n1', 'n2'" in message
    assert "medium: wired" in message


def test_a_link_with_bandwidth_needs_no_position():
    links = line(2, bandwidth_MBps=2.0).links

    assert rates_MBps(Network((node(0), node(1)), links), "raw_phy") == [2.0, 2.0]


def test_out_of_range_is_no_bandwidth():
    assert rates_MBps(single(140.0).network()) == [0.0]


def test_latency_comes_from_the_link():
    network = line(2, bandwidth_MBps=None, latency_s=0.25)

    rates = WifiLinkModel(make_context(network)).rate_links(network)

    assert rates.latency_s == (0.25, 0.25)


@pytest.mark.parametrize(("width", "expected_MBps"), [(20, 8.6), (40, 17.2), (160, 68.8)])
def test_wider_channels_are_faster(width, expected_MBps):
    assert rates_MBps(thirty_metres(), "raw_phy", channel_width_mhz=width) == [expected_MBps]


def test_rts_cts_costs_goodput_of_a_lone_link():
    assert rates_MBps(thirty_metres(), rts_cts=True) < rates_MBps(thirty_metres())


@pytest.mark.parametrize("standard", ["n", "ac"])
def test_older_standards_are_slower(standard):
    assert rates_MBps(thirty_metres(), "raw_phy", wifi_standard=standard) == [6.5]


def test_shadowing_follows_the_seed_and_nothing_else():
    network = line(4, bandwidth_MBps=None, spacing_m=60.0)
    sections = {"rf": {"shadow_fading_sigma": 8.0}}

    def rates(seed, nodes=network.nodes):
        grown = Network(nodes, network.links)
        context = make_context(grown, seed=seed, sections=sections)
        return WifiLinkModel(context).rate_links(grown).bandwidth_MBps

    assert rates(1) == rates(1, (*network.nodes, node(9)))
    assert len({rates(seed) for seed in range(8)}) > 1


def test_a_link_has_the_same_rate_in_any_network():
    longer = line(5, bandwidth_MBps=None)
    alone = Network(longer.nodes[:2], longer.links[:2])

    assert rates_MBps(longer)[:2] == rates_MBps(alone)


def test_links_between_the_same_nodes_are_rated_each_for_itself():
    network = network_of([each.position for each in line(2).nodes], [(0, 1)], bandwidth_MBps=None)
    twin = replace(network.links[0], id=LinkId("twin"), bandwidth_MBps=1.0)

    rates = rates_MBps(Network(network.nodes, (*network.links, twin)), "raw_phy")

    assert rates == [6.45, 6.45, 1.0]
