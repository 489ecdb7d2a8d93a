from dataclasses import replace

import pytest
from ncsim_core.errors import ModelScopeError
from ncsim_core.network import Network
from ncsim_core.testing.builders import make_context
from ncsim_wifi.interference_models.csma_bianchi import csma_bianchi
from ncsim_wifi.interference_models.fixed_capture import capture_success
from ncsim_wifi.mac.efficiency import data_airtime_fraction
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation.engine_runs import FIXED_CAPTURE, measure
from ncsim_wifi.validation.scenes import Scene, parallel, single


def model_of(network, *, options=None, **rf):
    context = make_context(network, sections={"rf": rf})
    return csma_bianchi(context, hidden_model="fixed_capture", **(options or {}))


@pytest.mark.parametrize("separation_m", [72.0, 80.0, 114.0])
def test_a_hidden_frame_that_is_not_decoded_is_lost(separation_m):
    factors = model_of(parallel(2, separation_m).network()).factors([0, 1], [0, 1])

    idle = 1.0 - data_airtime_fraction(68.8, AxTiming())
    assert factors.tolist() == [idle, idle]


def test_a_frame_exactly_at_the_decode_threshold_is_decoded():
    assert capture_success(0.6, 17.0, 17.0) == 1.0
    assert capture_success(0.6, 16.999, 17.0) == 1.0 - 0.6


def test_a_hidden_frame_that_is_decoded_costs_nothing():
    assert model_of(parallel(2, 115.0).network()).factors([0, 1], [0, 1]).tolist() == [1.0, 1.0]


def test_an_interferer_without_any_rate_sends_nothing():
    scene = Scene(((0.0, 0.0), (0.0, 80.0)), ((30.0, 0.0), (200.0, 80.0)), ())

    assert model_of(scene.network()).factors([0], [0, 1]).tolist() == [1.0]


def test_a_floor_holds_for_lost_frames_too():
    network = parallel(2, 80.0).network()
    model = model_of(network, options={"outage_floor_factor": 0.6})

    assert model.factors([0, 1], [0, 1]).tolist() == [0.6, 0.6]
    assert model.factors([0], [0]).tolist() == [1.0]


def test_what_is_left_out_counts_for_nothing():
    network = parallel(3, 50.0).network()  # of which the outer links are hidden from each other
    contention, hidden = (
        model_of(network, options={"components": name}).factors([0, 1, 2], [0, 1, 2])
        for name in ("contention_only", "hidden_only")
    )

    default = csma_bianchi(make_context(network), components="contention_only")
    assert contention.tolist() == default.factors([0, 1, 2], [0, 1, 2]).tolist()
    idle = 1.0 - data_airtime_fraction(68.8, AxTiming())
    assert hidden.tolist() == [idle, 1.0, idle]


def test_a_wider_margin_decodes_nearer_interferers():
    network = parallel(2, 80.0).network()

    assert model_of(network, capture_margin_dB=9.0).factors([0], [0, 1]).tolist() == [1.0]


def test_pure_contention_follows_the_default_rule():
    network = parallel(3, 20.0).network()
    default = csma_bianchi(make_context(network))

    captured = model_of(network).factors([0, 1, 2], [0, 1, 2])

    assert captured.tolist() == default.factors([0, 1, 2], [0, 1, 2]).tolist()


def test_two_hidden_interferers_are_refused_by_name():
    model = model_of(parallel(3, 80.0).network())

    with pytest.raises(ModelScopeError) as caught:
        model.factors([0, 1, 2], [0, 1, 2])

    message = str(caught.value)
    assert "'l1' (contenders: none; hidden interferers: 'l0', 'l2')" in message
    assert "effective_rate" in message


def test_hidden_and_sensed_together_are_refused_by_name():
    model = model_of(parallel(3, 50.0).network())

    with pytest.raises(ModelScopeError, match=r"'l0' \(contenders: 'l1'; hidden .*: 'l2'\)"):
        model.factors([0], [0, 1, 2])


def test_a_bandwidth_that_is_no_rate_of_the_table_cannot_be_decoded_or_not():
    network = parallel(2, 80.0).network()
    odd = replace(network.links[0], bandwidth_MBps=5.0)
    model = model_of(Network(network.nodes, (odd, network.links[1])))

    assert model.factors([0], [0]).tolist() == [1.0]
    with pytest.raises(ModelScopeError, match=r"'l0' has a hidden .* 40 Mb/s is no rate"):
        model.factors([0], [0, 1])


@pytest.mark.parametrize(
    ("rf", "told"),
    [
        ({"wifi_standard": "ac"}, "wifi_standard is 'ac'"),
        ({"channel_width_mhz": 40}, "channel_width_mhz is 40"),
        ({"rts_cts": True}, "rts_cts is on"),
    ],
)
def test_other_radios_are_refused_with_the_links_they_concern(rf, told):
    model = model_of(parallel(2, 80.0).network(), **rf)

    with pytest.raises(ModelScopeError, match=rf"{told}\), so .* links 'l0', 'l1'"):
        model.factors([0, 1], [0, 1])


@pytest.mark.parametrize("rf", [{"rts_cts": True}, {"channel_width_mhz": 80}])
def test_a_run_with_another_radio_ends_as_failed_too(rf):
    scene = replace(single(30.0), radio=Radio(**rf))

    result = measure(scene, FIXED_CAPTURE).result

    assert (result.status, result.makespan_s) == ("failed", None)
    assert "'l0'" in result.detail


def test_the_engine_ends_a_run_beyond_its_scope_as_failed():
    measured = measure(parallel(3, 80.0), FIXED_CAPTURE)

    assert measured.result.status == "failed"
    assert measured.result.makespan_s is None
    assert "'l1'" in measured.result.detail
