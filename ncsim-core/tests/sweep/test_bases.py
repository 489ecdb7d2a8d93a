"""What a sweep starts from: a scenario file, parts of files, rows, generators."""

import pytest
import yaml
from ncsim_core.api import simulate
from ncsim_core.scenario.faults import ScenarioFaults
from ncsim_core.scenario.loader import load_scenario
from ncsim_core.sweep.reading import load_sweep
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.sweep.running import run_sweep


def scenario_rows(cost, bandwidth):
    return {
        "scenario": {
            "network": {
                "nodes": [
                    {"id": "a", "compute_capacity": 100},
                    {"id": "b", "compute_capacity": 50},
                ],
                "links": [
                    {"id": "ab", "from": "a", "to": "b", "bandwidth": bandwidth},
                    {"id": "ba", "from": "b", "to": "a", "bandwidth": bandwidth},
                ],
            },
            "dags": [
                {
                    "id": "d",
                    "tasks": [{"id": t, "compute_cost": cost} for t in ("A", "B")],
                    "edges": [{"from": "A", "to": "B", "data_size": 4}],
                }
            ],
            "config": {"scheduler": "round_robin"},
        }
    }


@pytest.fixture
def folder(tmp_path):
    inner = tmp_path / "inputs"
    inner.mkdir()
    for name, cost, bandwidth in (("small", 100, 2), ("large", 300, 1)):
        (inner / f"{name}.yaml").write_text(yaml.safe_dump(scenario_rows(cost, bandwidth)))
    return tmp_path


def done(folder, **sweep):
    (folder / "sweep.yaml").write_text(yaml.safe_dump({"sweep": sweep}))
    with run_sweep(folder / "sweep.yaml", executor="serial") as results:
        return results.table().to_dicts()


def test_a_scenario_file_is_run_as_it_is(folder):
    rows = done(folder, base={"scenario": "inputs/small.yaml"}, vary={"queue": ["fifo"]})

    assert rows[0]["makespan_s"] == simulate(folder / "inputs" / "small.yaml").makespan_s == 5.0
    assert rows[0]["seed"] == 42


def test_config_paths_of_a_scenario_file_are_varied(folder):
    vary = {"scheduler": ["round_robin", "all_on_fastest"]}
    rows = done(folder, base={"scenario": "inputs/small.yaml"}, vary=vary)

    assert [row["makespan_s"] for row in rows] == [5.0, 2.0]


def test_network_and_dags_may_come_from_different_files(folder):
    base = {"network": {"file": "inputs/small.yaml"}, "dags": {"file": "inputs/large.yaml"}}
    rows = done(folder, base={**base, "config": {"scheduler": "round_robin"}})

    assert rows[0]["makespan_s"] == 3.0 + 2.0 + 6.0


def test_files_are_varied_like_any_parameter(folder):
    base = {"scenario": "inputs/small.yaml", "dags": {"file": "inputs/small.yaml"}}
    vary = {"dags.file": ["inputs/small.yaml", "inputs/large.yaml"]}
    rows = done(folder, base=base, vary=vary)

    assert [row["makespan_s"] for row in rows] == [5.0, 11.0]


def test_parts_are_varied_as_a_whole(folder):
    base = {"network": {"file": "inputs/small.yaml"}, "config": {"scheduler": "round_robin"}}
    vary = {"dags": [{"file": "inputs/large.yaml"}, {"type": "chain", "tasks": 1}]}
    rows = done(folder, base=base, vary=vary)

    assert [row["makespan_s"] for row in rows] == [11.0, 5.0]


def test_rows_stand_in_the_sweep_itself(folder):
    parts = scenario_rows(100, 4)["scenario"]
    rows = done(folder, base={key: parts[key] for key in ("network", "dags", "config")})

    assert rows[0]["makespan_s"] == 1.0 + 1.0 + 2.0


def test_the_scenario_of_a_run_is_that_of_the_file(folder):
    (folder / "sweep.yaml").write_text("sweep: {base: {scenario: inputs/small.yaml}}")
    plan = load_sweep(folder / "sweep.yaml")
    scenario = Resolver(plan).scenario(next(plan.runs()))

    assert scenario == load_scenario(folder / "inputs" / "small.yaml")


def test_a_fault_in_a_file_is_told_with_its_place_there(folder):
    path = folder / "inputs" / "small.yaml"
    path.write_text(path.read_text().replace("bandwidth: 2", "bandwdth: 2", 1))
    (folder / "sweep.yaml").write_text("sweep: {base: {scenario: inputs/small.yaml}}")
    with pytest.raises(ScenarioFaults) as caught:
        load_sweep(folder / "sweep.yaml")

    assert "small.yaml:" in str(caught.value)
    assert "did you mean 'bandwidth'" in str(caught.value)


def test_every_generator_makes_a_run_that_completes():
    networks = [
        {"type": "grid", "rows": 2, "columns": 3},
        {"type": "paper_grid", "size": 2},
        {"type": "line", "nodes": 3},
        {"type": "ring", "nodes": 5},
        {"type": "star", "leaves": 4},
        {"type": "random_geometric", "nodes": 6, "side_m": 60, "range_m": 50},
        {"type": "random_geometric", "nodes": 6, "side_m": 60, "range_m": 90, "connected": False},
        {"type": "clustered", "clusters": 2, "nodes_each": 3, "side_m": 60, "spread_m": 8,
         "range_m": 60},
    ]  # fmt: skip
    dags = [
        {"type": "paper", "tasks": 5},
        {"type": "chain", "tasks": 3},
        {"type": "fork_join", "width": 2},
        {"type": "diamond", "size": 2},
        {"type": "layered_random", "layers": 3, "width": 2},
        {"type": "out_tree", "depth": 2, "branching": 2},
        {"type": "gaussian_elimination", "size": 3},
        {"type": "fft", "points": 4},
    ]
    base = {
        "network": networks[0],
        "dags": dags[0],
        "config": {"routing": "minimum_hop", "interference": "csma_bianchi", "scheduler": "heft"},
    }
    sweep = {"base": base, "vary": {"network": networks, "dags": dags}}
    with run_sweep({"sweep": sweep}, executor="serial") as results:
        rows = results.table().to_dicts()

    assert len(rows) == 64
    assert {row["status"] for row in rows} == {"completed"}
