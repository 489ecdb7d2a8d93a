from dataclasses import replace

import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.network import Network
from ncsim_core.testing.builders import line, make_context, node
from ncsim_wifi.interference_models.csma_bianchi import csma_bianchi
from ncsim_wifi.mac.efficiency import efficiency
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.validation.scenes import parallel

A, B, C = 0, 1, 2


def factors(network, **options):
    links = range(len(network.links))
    return csma_bianchi(make_context(network), **options).factors(links, links).tolist()


def mixed():
    """Three links of which neighbours hear each other and the outer two do not."""
    return parallel(3, 50.0).network()


def test_contention_alone_ignores_hidden_interferers():
    both, contention = factors(mixed()), factors(mixed(), components="contention_only")

    eta = [efficiency(n, 68.8, AxTiming()) for n in (1, 2, 3)]
    assert contention[B] == both[B] == pytest.approx(eta[2] / (3 * eta[0]))
    assert contention[A] == pytest.approx(eta[1] / (2 * eta[0]))
    assert contention[A] > both[A]


def test_hidden_interference_alone_ignores_contenders():
    hidden = factors(mixed(), components="hidden_only")

    assert hidden[B] == 1.0
    served = 51.6 * efficiency(1, 51.6, AxTiming()) / (68.8 * efficiency(1, 68.8, AxTiming()))
    assert hidden[A] == hidden[C] == pytest.approx(served)


def test_the_floor_holds_a_link_in_outage_up():
    crowd = parallel(12, 72.0).network()
    links = range(len(crowd.links))
    radio = {"rf": {"capture_margin_dB": 0.0, "tx_power_dBm": 20.0}}
    context = make_context(crowd, sections=radio)

    without = csma_bianchi(context).factors(links, links)
    floored = csma_bianchi(context, outage_floor_factor=0.6).factors(links, links)

    assert min(without) < 0.6
    assert floored.tolist() == [max(0.6, factor) for factor in without.tolist()]


def test_wired_links_neither_suffer_nor_disturb():
    network = parallel(3, 5.0).network()
    wired = replace(network.links[B], medium="wired", bandwidth_MBps=5.0)
    mixed_media = Network(network.nodes, (network.links[A], wired, network.links[C]))

    found = factors(mixed_media)

    assert found[B] == 1.0
    assert found[A] == found[C] == factors(parallel(2, 10.0).network())[0]


def test_two_links_of_one_transmitter_both_count():
    """Hidden power is summed per active link, not per radio (SPEC 5)."""
    scene = parallel(2, 80.0)
    network = scene.network()
    third = node(9, at=replace(network.nodes[-1].position, y_m=85.0))
    extra = replace(network.links[1], id="extra", target=third.id)
    model = csma_bianchi(make_context(Network((*network.nodes, third), (*network.links, extra))))

    one, two = (model.factors([0], active)[0] for active in ([0, 1], [0, 1, 2]))

    assert two < one
    assert model.competition([0], [0, 1, 2])[0].hidden_interferers == 2


def test_all_links_without_positions_are_named():
    bare = line(2, bandwidth_MBps=2.0)

    with pytest.raises(ScenarioError, match=r"csma_bianchi.*'n0_n1' \('n0', 'n1'\), 'n1_n0'"):
        csma_bianchi(make_context(Network((node(0), node(1)), bare.links)))


def test_runs_on_one_network_share_a_model():
    context = make_context(mixed())

    assert csma_bianchi(context) is csma_bianchi(context)
    assert csma_bianchi(context) is not csma_bianchi(context, components="hidden_only")


def test_competition_tells_contenders_interferers_and_what_hidden_power_costs():
    model = csma_bianchi(make_context(mixed()))

    told = model.competition([A, B, C], [A, B, C])

    assert told[A] == (1, 1, 0.75)
    assert told[B] == (2, 0, 1.0)
