import itertools
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.registry import Registry
from ncsim_core.scenario import load_scenario, parse_scenario
from ncsim_core.testing.scenario_strategies import scenarios

names = st.text(st.characters(exclude_categories=["C", "Z"]), min_size=1, max_size=6)
amounts = st.floats(0, 1e12) | st.integers(0, 10**6)
moments = st.floats(0, 1e6)


@st.composite
def odd_scenarios(draw):
    """Return scenarios with any ids, numbers and texts that are allowed."""
    nodes = draw(st.lists(names, min_size=1, max_size=4, unique=True))
    tasks = draw(st.lists(names, min_size=1, max_size=4, unique=True))
    ends = st.tuples(st.sampled_from(nodes), st.sampled_from(nodes)).filter(lambda p: p[0] != p[1])
    links = draw(st.lists(ends, max_size=3)) if len(nodes) > 1 else []
    return {
        "scenario": {
            "name": draw(st.text()),
            "description": draw(st.text()),
            "network": {
                "nodes": [{"id": node, "compute_capacity": draw(amounts) + 1} for node in nodes],
                "links": [
                    {"id": f"l{i}", "from": a, "to": b, "bandwidth": draw(amounts)}
                    for i, (a, b) in enumerate(links)
                ],
            },
            "dags": [
                {
                    "id": draw(names),
                    "inject_at": draw(moments),
                    "tasks": [{"id": task, "compute_cost": draw(amounts)} for task in tasks],
                    "edges": [
                        {"from": a, "to": b, "data_size": draw(amounts)}
                        for a, b in itertools.pairwise(tasks)
                    ],
                }
            ],
            "config": {"seed": draw(st.integers(0, 2**63))},
        }
    }


@given(odd_scenarios())
def test_a_resolved_document_reads_back_equal(core: Registry, document):
    scenario = parse_scenario(document, registry=core)

    again = parse_scenario(scenario.to_document(), registry=core)
    assert again == scenario
    assert again.sha256 == scenario.sha256


@given(odd_scenarios())
def test_a_resolved_scenario_reads_back_equal_from_yaml_and_json(core: Registry, document):
    scenario = parse_scenario(document, registry=core)

    assert parse_scenario(scenario.to_yaml(), registry=core) == scenario
    assert parse_scenario(json.dumps(scenario.to_document()), registry=core) == scenario


@given(scenarios())
def test_drawn_scenarios_read_back_equal(core: Registry, document):
    document["scenario"]["config"]["scheduler"] = "round_robin"
    for link in document["scenario"]["network"]["links"]:
        link.setdefault("bandwidth", 1)
    scenario = parse_scenario(document, registry=core)

    assert parse_scenario(scenario.to_yaml(), registry=core) == scenario


def document(**config):
    return {
        "scenario": {
            "name": "x",
            "network": {"nodes": [{"id": "n", "compute_capacity": 1}]},
            "dags": [{"id": "d", "tasks": [{"id": "t", "compute_cost": 1}]}],
            "config": config,
        }
    }


def test_every_default_is_written_out(core: Registry):
    scenario = parse_scenario(document(), registry=core).to_document()["scenario"]

    assert scenario["config"] == {
        "seed": 42,
        "scheduler": {"type": "round_robin"},
        "routing": {"type": "direct"},
        "link_model": {"type": "static"},
        "interference": {"type": "none"},
        "queue": {"type": "fifo"},
        "dag_source": {"type": "single"},
    }
    assert scenario["network"]["links"] == []
    assert scenario["dags"][0]["inject_at"] == 0.0


def test_defaults_of_options_and_sections_are_written_out(with_antenna: Registry):
    resolved = parse_scenario(document(interference="static_noise"), registry=with_antenna)

    config = resolved.to_document()["scenario"]["config"]
    assert config["link_model"] == {"type": "antenna", "options": {"gain_dB": 2.0}}
    assert config["air"] == {"noise_dBm": -95.0}


def test_equal_scenarios_have_equal_hashes_however_they_are_written(with_antenna: Registry):
    short = document(link_model="antenna", seed=7, queue="fifo")
    long = document(queue={"type": "fifo"}, seed=7.0, air={"noise_dBm": -95})
    long["scenario"]["config"]["link_model"] = {"type": "antenna", "options": {"gain_dB": 2}}

    hashes = {parse_scenario(each, registry=with_antenna).sha256 for each in (short, long)}
    assert len(hashes) == 1


def test_another_seed_is_another_scenario(core: Registry):
    hashes = {parse_scenario(document(seed=seed), registry=core).sha256 for seed in (1, 2)}

    assert len(hashes) == 2


@pytest.mark.parametrize("suffix", ["yaml", "json"])
def test_a_file_without_name_is_called_by_its_file_name(core: Registry, tmp_path, suffix):
    plain = document()
    del plain["scenario"]["name"]
    path = tmp_path / f"grid.{suffix}"
    path.write_text(json.dumps(plain))

    assert load_scenario(path, registry=core).name == "grid"
