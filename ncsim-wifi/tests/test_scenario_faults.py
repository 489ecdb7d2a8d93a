"""Radio scenarios that are wrong: each fault is told where it stands, before anything runs."""

import pytest
from ncsim_core.scenario.faults import ScenarioFaults
from ncsim_core.scenario.loader import parse_scenario

TEXT = """\
scenario:
  network:
    nodes:
      - {{id: a, compute_capacity: 1{a}}}
      - {{id: b, compute_capacity: 1, position: {{x: 30, y: 0}}}}
    links:
      - {{id: l, from: a, to: b{link}}}
  dags: [{{id: d, tasks: [{{id: t, compute_cost: 1, pinned_to: a}}], edges: []}}]
  config:
    scheduler: manual
    interference: {interference}
    link_model: {link_model}
    rf: {{{rf}}}
"""
PLACED = ", position: {x: 0, y: 0}"


def faults(a=PLACED, link="", interference="csma_bianchi", link_model="wifi", rf=""):
    text = TEXT.format(a=a, link=link, interference=interference, link_model=link_model, rf=rf)
    with pytest.raises(ScenarioFaults) as caught:
        parse_scenario(text, name="s.yaml")
    return str(caught.value)


@pytest.mark.parametrize(
    ("rf", "told"),
    [
        ("tx_power_dBm: 101", "tx_power_dBm: must be at most 100"),
        ("tx_power_dbm: 20", "unknown key 'tx_power_dbm'; did you mean 'tx_power_dBm'?"),
        ("freq_ghz: 0", "freq_ghz: must be at least 0.01"),
        ("path_loss_exponent: -2", "path_loss_exponent: must be at least 0.1"),
        ("noise_floor_dBm: loud", "noise_floor_dBm: must be a number"),
        ("cca_threshold_dBm: -300", "cca_threshold_dBm: must be at least -200"),
        ("channel_width_mhz: 25", "channel_width_mhz: must be one of 20, 40, 80, 160"),
        ("wifi_standard: acc", "must be one of ac, ax, n, not 'acc'; did you mean 'ac'?"),
        ("shadow_fading_sigma: -1", "shadow_fading_sigma: must be at least 0"),
        ("rts_cts: 1", "rts_cts: must be true or false"),
        ("capture_margin_dB: .nan", "capture_margin_dB: "),
        ("interference_cutoff_dBm: .inf", "interference_cutoff_dBm: must be at most 100"),
    ],
)
def test_a_wrong_value_of_rf_is_told_at_its_place(rf, told):
    message = faults(rf=rf)

    assert message.startswith("s.yaml:13:")
    assert told in message


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ("hidden_model: fixed", "hidden_model: must be one of effective_rate, fixed_capture"),
        ("components: all", "components: must be one of combined, contention_only, hidden_only"),
        ("outage_floor_factor: 1.5", "outage_floor_factor: must be at most 1"),
        ("outage_floor_factor: -0.1", "outage_floor_factor: must be at least 0"),
        ("floor: 0.1", "unknown key 'floor'"),
    ],
)
def test_a_wrong_option_is_told_at_its_place(options, told):
    message = faults(interference=f"{{type: csma_bianchi, options: {{{options}}}}}")

    assert message.startswith("s.yaml:11:")
    assert told in message


@pytest.mark.parametrize("rf", ["channel_width_mhz: 20.5", "wifi_standard: 3"])
def test_a_value_of_the_wrong_type_that_is_no_choice_is_one_fault(rf):
    assert faults(rf=rf).count("s.yaml:13:") == 1


def test_a_node_without_position_is_told_with_what_it_is_needed_for():
    assert faults(a="").startswith(
        "s.yaml:4:9  network.nodes[0]: node 'a' needs a position: link model wifi derives the rate "
        "of link 'l' from it; or give that link a bandwidth, MB/s, and medium: wired"
    )


@pytest.mark.parametrize("link_model", ["wifi", "static"])
def test_interference_needs_positions_even_where_bandwidths_are_written(link_model):
    assert faults(a="", link=", bandwidth: 2", link_model=link_model).startswith(
        "s.yaml:4:9  network.nodes[0]: node 'a' needs a position: interference csma_bianchi "
        "derives from it what link 'l' hears; or mark that link medium: wired"
    )


def test_a_wired_link_without_bandwidth_is_told_and_asks_for_no_position():
    message = faults(a="", link=", medium: wired")

    assert message.startswith("s.yaml:7:9  network.links[0]: a wired link needs a bandwidth, MB/s")
    assert "position" not in message


def notes(link_model, interference, scheduler="manual"):
    text = TEXT.format(
        a=PLACED,
        link=", bandwidth: 2",
        interference=interference,
        link_model=link_model,
        rf="tx_power_dBm: 10",
    ).replace("scheduler: manual", f"scheduler: {scheduler}")
    return parse_scenario(text, name="s.yaml").notes


def test_radio_parameters_that_nobody_reads_are_noted():
    assert notes("static", "none") == (
        "config.rf has no effect with link_model static, interference none",
    )
    assert notes("wifi", "none") == notes("static", "csma_bianchi") == ()
    assert notes("static", "none", "conflict_aware_heft") == ()
