"""Chains far longer than Python's recursion limit, through every verb.

3,000 tasks are three times the limit, which is all that matters; by hand 50,000 were taken.
"""

import json
import sys
from pathlib import Path

import pytest
from ncsim_core.cli.main import main

LENGTH = 3000


def ncsim(*words):
    with pytest.raises(SystemExit) as end:
        main([*map(str, words)])
    return end.value.code


def chain(scheduler="round_robin"):
    ends = ("a", "b")
    links = [{"id": f"{a}{b}", "from": a, "to": b, "bandwidth": 10} for a, b in (ends, ends[::-1])]
    edges = [{"from": f"t{k}", "to": f"t{k + 1}", "data_size": 0.01} for k in range(LENGTH - 1)]
    config = {"scheduler": scheduler, "routing": "direct", "interference": "none"}
    return {
        "scenario": {
            "network": {
                "nodes": [{"id": end, "compute_capacity": 100} for end in ends],
                "links": links,
            },
            "dags": [
                {
                    "id": "d",
                    "tasks": [{"id": f"t{k}", "compute_cost": 1} for k in range(LENGTH)],
                    "edges": edges,
                }
            ],
            "config": config,
        }
    }


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Return a folder in which the chain has been run from JSON and from YAML."""
    folder = tmp_path_factory.mktemp("chain")
    (folder / "chain.json").write_text(json.dumps(chain()), encoding="utf-8")
    assert sys.getrecursionlimit() < LENGTH
    assert ncsim("run", folder / "chain.json", "-q", "-o", folder / "one") == 0
    assert ncsim("run", folder / "one" / "scenario.yaml", "-q", "-o", folder / "two") == 0
    return folder


def test_json_and_yaml_give_the_same_trace(runs):
    one, two = ((runs / name / "trace.jsonl").read_text("utf-8") for name in ("one", "two"))

    # the header alone tells the scenarios' names apart
    assert one.split("\n", 1)[1] == two.split("\n", 1)[1]


@pytest.mark.parametrize(
    "verb",
    [
        "validate {0}/one/scenario.yaml",
        "explain {0}/one",
        "compare {0}/one {0}/two",
        "export {0}/one --to published -o -",
        "export {0}/one --to csv -o {0}/csv",
        "export {0}/one --to perfetto -o -",
        "trace check {0}/one",
        "trace show {0}/one",
        "view {0}/one -o {0}/page.html",
    ],
)
def test_a_verb_takes_a_chain_of_any_length(verb, runs):
    assert ncsim(*verb.format(runs).split()) == 0


@pytest.mark.parametrize("scheduler", ["heft", "cpop", "all_on_fastest"])
def test_a_scheduler_takes_a_chain_of_any_length(scheduler, tmp_path):
    path = Path(tmp_path, "chain.json")
    path.write_text(json.dumps(chain(scheduler)), encoding="utf-8")

    assert ncsim("run", path, "-q", "--trace", "off") == 0


def test_a_cycle_of_any_length_is_told(tmp_path, capsys):
    scenario = chain()
    back = {"from": f"t{LENGTH - 1}", "to": "t0", "data_size": 1}
    scenario["scenario"]["dags"][0]["edges"].append(back)
    path = Path(tmp_path, "cycle.json")
    path.write_text(json.dumps(scenario), encoding="utf-8")

    assert ncsim("validate", path) == 1
    assert "the edges form a cycle" in capsys.readouterr().err
