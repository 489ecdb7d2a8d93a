import pytest
from ncsim_core.registry import Registry, load_registry
from ncsim_core.scenario import ScenarioFaults, parse_scenario

NEEDY = """
from ncsim_core.plugins import Component, hookimpl

NCSIM_PLUGIN_API = "1.0"


@hookimpl
def ncsim_components():
    return [
        Component("interference_model", "fog", "fog:Fog", "x", capabilities={"needs_radio"}),
        Component("scheduler", "heft", "fog:Heft", "x"),
        Component("scheduler", "dear", "fog:Dear", "x", requires=("no-such-package>=2",)),
    ]
"""


def scenario_text(config: str, bandwidth: str = "") -> str:
    return (
        "scenario: {network: {nodes: [{id: n, compute_capacity: 1, position: {x: 0, y: 0}}, "
        "{id: m, compute_capacity: 1, position: {x: 1, y: 0}}], "
        f"links: [{{id: l, from: n, to: m{bandwidth}}}]}}, "
        f"dags: [{{id: d, tasks: [{{id: t, compute_cost: 1}}]}}], config: {config}}}"
    )


def chosen(config, registry, bandwidth=", bandwidth: 1"):
    components = parse_scenario(
        scenario_text(config, bandwidth), registry=registry
    ).config.components
    return {kind: spec.name for kind, spec in components.items()}


def test_round_robin_stands_in_where_heft_is_not_installed(core: Registry):
    assert chosen("{}", core)["scheduler"] == "round_robin"


def test_heft_is_the_default_where_it_is_installed(fake_dist):
    fake_dist("fog", {"fog_plugin": NEEDY})

    assert chosen("{}", load_registry({"NCSIM_PLUGINS": "fog"}))["scheduler"] == "heft"


@pytest.mark.parametrize("config", ["{interference: static_noise}", "{air: {}}"])
def test_what_needs_a_radio_brings_the_radio_link_model(config, with_antenna: Registry):
    assert chosen(config, with_antenna, bandwidth="")["link_model"] == "antenna"


def test_a_link_model_that_is_named_stays(with_antenna: Registry):
    names = chosen("{interference: static_noise, link_model: static}", with_antenna)

    assert names["link_model"] == "static"


def test_without_any_wish_for_a_radio_the_link_model_is_static(with_antenna: Registry):
    assert chosen("{}", with_antenna)["link_model"] == "static"


def test_a_wish_for_a_radio_without_one_installed_is_a_fault(fake_dist):
    fake_dist("fog", {"fog_plugin": NEEDY})
    registry = load_registry({"NCSIM_PLUGINS": "fog"})

    with pytest.raises(ScenarioFaults, match=r"asks for a link model .* no installed plug-in has"):
        chosen("{interference: fog}", registry)


def test_a_section_nobody_uses_is_left_out(with_antenna: Registry):
    assert (
        parse_scenario(scenario_text("{}", ", bandwidth: 1"), registry=with_antenna).config.sections
        == {}
    )


def test_the_missing_bandwidth_names_the_models_that_do_without(with_antenna: Registry):
    with pytest.raises(ScenarioFaults, match=r"derives it from positions \(antenna\)"):
        chosen("{}", with_antenna, bandwidth="")


@pytest.mark.parametrize(
    ("config", "message"),
    [
        ("{scheduler: dear}", "config.scheduler: .* needs no-such-package>=2"),
        ("{scheduler: {type: dear}}", "config.scheduler.type: .* needs no-such-package>=2"),
        ("{scheduler: a/heft}", "config.scheduler: unknown scheduler 'a/heft'"),
        ("{scheduler: dear, sead: 1}", "(?s)config.scheduler: .*config.sead: unknown key"),
    ],
)
def test_a_component_that_cannot_be_had_is_a_fault_at_its_name(config, message, fake_dist):
    fake_dist("fog", {"fog_plugin": NEEDY})

    with pytest.raises(ScenarioFaults, match=message):
        chosen(config, load_registry({"NCSIM_PLUGINS": "fog"}))
