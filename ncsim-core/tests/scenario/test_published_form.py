"""Files of the published ncsim load, with a note for each thing that is put differently."""

from pathlib import Path

import pytest
from ncsim_core.registry import Registry, load_registry
from ncsim_core.scenario import ScenarioFaults, load_scenario, parse_scenario

EXAMPLES = sorted((Path(__file__).parents[3] / "examples" / "published-form").glob("*.yaml"))

PUBLISHED_MODELS = """
from ncsim_core.plugins import Component, Section, hookimpl

NCSIM_PLUGIN_API = "1.0"


def options(**properties):
    return {"type": "object", "additionalProperties": False, "properties": properties}


@hookimpl
def ncsim_components():
    any_text = {"type": "string", "description": "x"}
    return [
        Component(
            "link_model",
            "wifi",
            "x:y",
            "x",
            options=options(rate=any_text),
            capabilities=frozenset({"radio"}),
        ),
        Component(
            "interference_model",
            "csma_bianchi",
            "x:y",
            "x",
            options=options(hidden_model=any_text),
            capabilities=frozenset({"needs_radio"}),
        ),
        Component(
            "interference_model",
            "proximity",
            "x:y",
            "x",
            options=options(radius={"type": "number", "description": "m", "minimum": 0}),
        ),
        Component(
            "scheduler",
            "fcp",
            "x:y",
            "x",
            options=options(size={"type": "integer", "description": "tasks", "minimum": 1}),
        ),
    ]
"""


@pytest.fixture
def published(fake_dist) -> Registry:
    """Return a registry that has what published files name."""
    fake_dist("published", {"published_plugin": PUBLISHED_MODELS})
    return load_registry({"NCSIM_PLUGINS": "published"})


def text(config: str, *, root: bool = True, ids: str = "n", position: bool = True) -> str:
    at = ", position: {x: 0, y: 0}" if position else ""
    body = (
        f"network: {{nodes: [{{id: {ids}0, compute_capacity: 1{at}}}, "
        f"{{id: {ids}1, compute_capacity: 1{at}}}], "
        f"links: [{{id: l, from: {ids}0, to: {ids}1, bandwidth: 4}}]}}, "
        f"dags: [{{id: d, tasks: [{{id: t, compute_cost: 1, pinned_to: {ids}0}}]}}], "
        f"config: {config}"
    )
    return f"{{scenario: {{{body}}}}}" if root else f"{{{body}}}"


def specs(scenario):
    return {
        kind: (spec.name, dict(spec.options)) for kind, spec in scenario.config.components.items()
    }


@pytest.mark.parametrize(
    ("mode", "rate", "interference"),
    [
        ("raw_phy", "raw_phy", "none"),
        ("solo_80211", "solo", "none"),
        ("full_wireless", "solo", "csma_bianchi"),
    ],
)
def test_a_mode_becomes_link_model_and_interference(mode, rate, interference, published):
    scenario = parse_scenario(text(f"{{interference: {mode}}}"), registry=published)

    assert specs(scenario)["link_model"] == ("wifi", {"rate": rate})
    assert specs(scenario)["interference_model"] == (interference, {})
    assert scenario.notes == (
        (
            f"config.interference: {mode} is read as link_model wifi (rate: {rate}) "
            f"with interference {interference}"
        ),
    )


def test_flat_scheduler_options_belong_to_the_scheduler(published):
    config = "{scheduler: fcp, scheduler_options: {size: 3}, interference: none}"

    scenario = parse_scenario(text(config), registry=published)

    assert specs(scenario)["scheduler"] == ("fcp", {"size": 3})
    assert scenario.notes == ("config.scheduler_options is read as the options of scheduler fcp",)


def test_the_hidden_terminal_model_belongs_to_bianchi(published):
    config = "{interference: full_wireless, hidden_terminal_model: fixed_capture}"

    scenario = parse_scenario(text(config), registry=published)

    assert specs(scenario)["interference_model"] == (
        "csma_bianchi",
        {"hidden_model": "fixed_capture"},
    )


def test_the_interference_radius_belongs_to_proximity(published):
    config = "{interference: proximity, interference_radius: 20}"

    scenario = parse_scenario(text(config), registry=published)

    assert specs(scenario)["interference_model"] == ("proximity", {"radius": 20.0})


def test_a_key_without_effect_is_dropped_with_a_note(published):
    config = "{interference: none, interference_radius: 20}"

    scenario = parse_scenario(text(config), registry=published)

    assert scenario.notes == (
        "config.interference_radius has no effect with interference none; left out",
    )


def test_a_missing_root_is_accepted_with_a_note(published):
    scenario = parse_scenario(text("{interference: none}", root=False), registry=published)

    assert scenario.notes == (
        "there is no 'scenario:' root; the whole file is read as the scenario",
    )


def test_the_published_default_interference_is_kept(published):
    scenario = parse_scenario(text("{}", root=False), registry=published)

    assert specs(scenario)["interference_model"] == ("proximity", {"radius": 15.0})
    assert "config.interference is not given: taken as proximity" in scenario.notes[1]


def test_a_file_that_may_have_been_written_for_the_published_tool_says_what_that_took(published):
    silent = parse_scenario(text("{seed: 1}"), registry=published)
    told = parse_scenario(text("{interference: none}"), registry=published)
    wireless = parse_scenario(text("{link_model: wifi}"), registry=published)

    assert specs(silent)["interference_model"] == ("none", {})
    (note,) = silent.notes
    assert note.startswith("config.interference is not given: taken as none; the published ncsim")
    assert told.notes == wireless.notes == ()


def test_a_default_that_is_not_installed_is_left_out_with_a_note(core: Registry):
    scenario = parse_scenario(text("{}", root=False), registry=core)

    assert specs(scenario)["interference_model"] == ("none", {})
    assert scenario.notes[1].endswith("is not installed; taken as none")


def test_numbers_as_ids_become_text_in_published_files_only(published):
    scenario = parse_scenario(text("{interference: none}", root=False, ids="1"), registry=published)

    assert [node.id for node in scenario.network.nodes] == ["10", "11"]
    assert scenario.injections[0].dag.tasks[0].pinned_to == "10"
    assert scenario.notes[1] == "numbers as ids are read as text: 10, 11"
    with pytest.raises(ScenarioFaults, match="must be text, not 10; put it in quotes"):
        parse_scenario(text("{interference: none}", ids="1"), registry=published)


def test_nodes_without_position_are_put_at_the_origin_as_they_were(published):
    scenario = parse_scenario(text("{interference: raw_phy}", position=False), registry=published)

    assert all(node.position for node in scenario.network.nodes)
    assert scenario.notes[0] == "nodes without position are put at (0, 0): n0, n1"


def test_unknown_keys_stay_faults_at_their_place(published):
    with pytest.raises(ScenarioFaults) as caught:
        parse_scenario("name: x\nnetwrk: {}\ndags: []\n", name="f", registry=published)

    assert (
        caught.value.faults[0].render().startswith("f:2:1  netwrk: unknown key 'netwrk'; did you")
    )


def test_faults_in_translated_parts_are_found_where_they_were_written(published):
    lines = "config:\n  scheduler: fcp\n  scheduler_options:\n    size: 0\n"
    body = "network: {nodes: [{id: n, compute_capacity: 0}]}\n"

    with pytest.raises(ScenarioFaults) as caught:
        parse_scenario(
            f"{lines}{body}dags: [{{id: d, tasks: [{{id: t, compute_cost: 1}}]}}]\n",
            registry=published,
        )

    places = [(fault.line, fault.column) for fault in caught.value.faults]
    assert places == [(4, 11), (5, 45)]


def test_a_mode_beside_another_link_model_is_a_fault(published):
    config = "{interference: raw_phy, link_model: static}"

    with pytest.raises(
        ScenarioFaults, match=r"raw_phy is link model wifi .*; leave link_model out"
    ):
        parse_scenario(text(config), registry=published)


def test_a_mode_without_the_package_for_it_is_explained(core: Registry):
    with pytest.raises(ScenarioFaults, match="'wifi' comes with ncsim-wifi"):
        parse_scenario(text("{interference: raw_phy}"), registry=core)


def test_published_modes_work_as_overrides_too(published):
    scenario = parse_scenario(
        text("{interference: none}"), {"interference": "full_wireless"}, registry=published
    )

    assert specs(scenario)["interference_model"][0] == "csma_bianchi"


def test_taking_interference_away_from_full_leaves_solo(published):
    full = text("{interference: full_wireless}")

    scenario = parse_scenario(full, {"interference": "none"}, registry=published)

    assert specs(scenario)["link_model"] == ("wifi", {"rate": "solo"})
    assert specs(scenario)["interference_model"] == ("none", {})


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_the_examples_in_published_form_load_with_notes(path):
    scenario = load_scenario(path)

    assert scenario.notes
    assert parse_scenario(scenario.to_yaml()) == scenario


def test_there_are_six_examples():
    assert len(EXAMPLES) == 6
