"""Expected numbers are worked out by hand from the makespans below."""

import json

import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.sweep.plan import canonical
from ncsim_core.sweep.reading import load_sweep
from ncsim_core.sweep.store import Store
from ncsim_core.sweep.worker import Item, ResultRow
from ncsim_viz.study import is_study, study_document

MAKESPANS_s = {  # (scheduler, interference, size): makespan; cpop wins in Full though not in Solo
    ("round_robin", "none", 1): 2, ("round_robin", "csma_toy", 1): 12,
    ("manual", "none", 1): 4, ("manual", "csma_toy", 1): 8,
    ("round_robin", "none", 2): 10, ("round_robin", "csma_toy", 2): 10,
    ("manual", "none", 2): 20, ("manual", "csma_toy", 2): None,
}  # fmt: skip


@pytest.fixture
def study(tmp_path, fake_dist):
    """Return the folder of a study with made-up makespans."""
    fake_dist("toy", {"toy_declaration": TOY})
    sweep = {
        "base": {
            "network": {"type": "line", "nodes": 2, "bandwidth_MBps": 1},
            "dags": {"type": "chain", "tasks": 2},
            "config": {"link_model": "static"},
        },
        "vary": {
            "scheduler": ["round_robin", "manual"],
            "interference": ["none", "csma_toy"],
            "dags.tasks": [1, 2],
        },
    }
    plan = load_sweep({"sweep": sweep})
    runs = list(plan.runs())
    folder = tmp_path / "study"
    folder.mkdir()
    with Store(folder) as store:
        store.register(plan, len(runs))
        store.enrol(plan, [Item(canonical([*run.values]), run) for run in runs])
        rows = [(canonical([*run.values]), MAKESPANS_s[run.values]) for run in runs]
        store.save(
            ResultRow(
                key, "failed" if s is None else "completed", None if s is None else s * 1_000_000,
                None, None, None, None, None, 0.1, None,
            )
            for key, s in rows
        )  # fmt: skip
    return folder


TOY = """
from ncsim_core.plugins import Component, hookimpl
NCSIM_PLUGIN_API = "1.0"
@hookimpl
def ncsim_components():
    return [Component("interference_model", "csma_toy",
                      "ncsim_core.builtin.interference_models:NoInterference", "None, renamed.")]
"""


def group(document, measure, *by):
    """Return a group's table as mappings."""
    found = next(g for g in document["groups"] if (g["measure"], g["by"]) == (measure, [*by]))
    table = found["table"]
    return [dict(zip(table["columns"], row, strict=True)) for row in table["rows"]]


def test_a_study_is_told_from_a_run(study, tmp_path):
    assert is_study(study)
    assert not is_study(tmp_path)


def test_winners_ratios_and_regret_are_told(study):
    document = study_document(study)
    table = document["winners"]
    first, second = (dict(zip(table["columns"], row, strict=True)) for row in table["rows"])

    assert document["roles"] == {
        "policy": "scheduler", "mode": "interference", "solo": "none", "full": "csma_toy",
    }  # fmt: skip
    assert (first["round_robin"], first["manual"]) == (1.5, 1.0)
    assert (first["solo_winners"], first["full_winners"]) == ("round_robin", "manual")
    assert (first["inversion"], first["regret"]) == (True, 0.5)
    assert second["manual"] is None
    assert document["totals"]["rows"][0] == ["cases", 2]


def test_slowdowns_pair_full_and_solo(study):
    rows = group(study_document(study), "slowdown", "scheduler")

    assert [(r["scheduler"], r["mean"], r["runs"], r["left_out"]) for r in rows] == [
        ("round_robin", (12 / 2 + 10 / 10) / 2, 2, 0),
        ("manual", 8 / 4, 1, 1),
    ]


def test_means_are_given_for_every_factor_and_pair(study):
    document = study_document(study)

    rows = group(document, "makespan_s", "scheduler", "dags.tasks")
    assert [r["mean"] for r in rows] == [7.0, 10.0, 6.0, 20.0]
    assert [r["mean"] for r in group(document, "regret", "dags.tasks")] == [0.5, 0.0]
    by = [tuple(g["by"]) for g in document["groups"] if g["measure"] == "makespan_s"]
    assert len(by) == len(set(by)) == 6


def test_a_condition_chooses_runs(study):
    document = study_document(study, where={"tasks": "1"})

    assert len(document["runs"]["rows"]) == 4
    assert document["numbers"] == [0, 2, 4, 6]
    assert len(document["factors"][2]["values"]) == 2  # what could be chosen stays
    with pytest.raises(ScenarioError, match="no_such"):
        study_document(study, where={"no_such": "1"})


def test_without_two_modes_there_are_means_and_a_reason(study):
    document = study_document(study, where={"interference": "none"})

    assert document["winners"] is document["roles"] is None
    assert "interference" in document["note"]
    assert {g["measure"] for g in document["groups"]} == {"makespan_s"}


def test_a_study_is_plain_json(study):
    json.dumps(study_document(study), allow_nan=False)
