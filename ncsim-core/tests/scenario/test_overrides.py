import pytest
from ncsim_core.registry import Registry
from ncsim_core.scenario import ScenarioFaults, parse_scenario


def scenario_text(config: str = "{}") -> str:
    return (
        "scenario: {network: {nodes: [{id: n, compute_capacity: 1, position: {x: 0, y: 0}}, "
        "{id: m, compute_capacity: 1, position: {x: 1, y: 0}}], links: [{id: l, from: n, to: m}]}, "
        f"dags: [{{id: d, tasks: [{{id: t, compute_cost: 1}}]}}], config: {config}}}"
    )


def spec_of(kind, config, overrides, registry):
    return parse_scenario(scenario_text(config), overrides, registry=registry).config.components[
        kind
    ]


def test_a_name_replaces_component_and_options(with_antenna: Registry):
    config = "{link_model: {type: broken_rates, options: {rates: [1]}}}"

    spec = spec_of("link_model", config, {"link_model": "antenna"}, with_antenna)

    assert (spec.name, spec.options) == ("antenna", {"gain_dB": 2.0})


def test_a_dotted_path_changes_one_option(with_antenna: Registry):
    for config in ("{link_model: antenna}", "{link_model: {type: antenna}}", "{air: {}}"):
        spec = spec_of("link_model", config, {"link_model.options.gain_dB": 9}, with_antenna)

        assert (spec.name, spec.options) == ("antenna", {"gain_dB": 9.0})


def test_a_name_and_its_options_may_come_together_in_any_order(with_antenna: Registry):
    overrides = {"link_model.options.gain_dB": 9, "link_model": "antenna"}

    assert spec_of("link_model", "{}", overrides, with_antenna).options == {"gain_dB": 9.0}


def test_seed_and_section_can_be_set_where_the_file_has_no_config(with_antenna: Registry):
    text = scenario_text().replace(", config: {}", "")

    config = parse_scenario(text, {"seed": 9, "air.noise_dBm": -80}, registry=with_antenna).config

    assert (config.seed, config.sections) == (9, {"air": {"noise_dBm": -80.0}})


def test_without_interference_the_radio_keeps_its_rates(with_antenna: Registry):
    config = "{interference: static_noise}"

    spec = spec_of("link_model", config, {"interference": "none"}, with_antenna)

    assert spec.name == "antenna"


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        ({"seed": "x"}, "override seed='x'  config.seed: must be a whole number"),
        ({"sead": 1}, "override sead=1  config.sead: unknown key 'sead'; did you mean 'seed'"),
        ({"queue": "lifo"}, "override queue='lifo'  config.queue: unknown queue_model 'lifo'"),
        (
            {"link_model.options.gain_dB": 99},
            "override link_model.options.gain_dB=99  config.link_model.options.gain_dB: must be at",
        ),
        (
            {"air.noise_dBm": float("inf")},
            "override air.noise_dBm=inf  config.air.noise_dBm: must be at most 0",
        ),
        ({"interference": 5}, "override interference=5  config.interference: must be the name"),
        ({"fog.depth.m": 2}, "override fog.depth.m=2  config.fog: unknown key 'fog'; known"),
        ({"seed.x": 2}, "override seed.x=2  config.seed: must be a whole number, not a mapping"),
        ({"interference": "fog"}, "override interference='fog'  config.interference: unknown"),
    ],
)
def test_a_fault_in_an_override_is_said_to_be_there(overrides, message, with_antenna: Registry):
    with pytest.raises(ScenarioFaults) as caught:
        parse_scenario(scenario_text("{link_model: antenna}"), overrides, registry=with_antenna)

    assert len(caught.value.faults) == 1
    assert caught.value.faults[0].render().startswith(message)


def test_a_file_with_a_broken_config_still_reports_its_own_faults(core: Registry):
    with pytest.raises(ScenarioFaults, match="config: must be a mapping, not a list"):
        parse_scenario(scenario_text("[]"), {"seed": 1}, registry=core)


def test_options_of_a_default_that_cannot_be_decided_are_a_fault(with_antenna: Registry):
    config, overrides = "{interference: fog}", {"link_model.options.gain_dB": 9}

    with pytest.raises(ScenarioFaults, match=r"config.interference: unknown") as caught:
        parse_scenario(scenario_text(config), overrides, registry=with_antenna)

    assert "config.link_model: 'type' is missing" in str(caught.value)
