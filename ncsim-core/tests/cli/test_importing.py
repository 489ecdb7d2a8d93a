"""``ncsim import``: a workflow becomes a list of DAGs, or a scenario that runs."""

import json
from pathlib import Path

import pytest
import yaml
from ncsim_core.cli.main import main
from ncsim_core.scenario.loader import load_scenario

ROOT = Path(__file__).parents[3]
FILM = ROOT / "examples" / "workflows" / "film_page.json"


def ncsim(*args):
    with pytest.raises(SystemExit) as stop:
        main([str(each) for each in args])
    return stop.value.code


@pytest.fixture
def host(tmp_path):
    path = tmp_path / "host.json"
    nodes = [{"id": name, "compute_capacity": 100} for name in ("a", "b")]
    links = [{"id": "ab", "from": "a", "to": "b", "bandwidth": 2}]
    dag = {"id": "own", "tasks": [{"id": "T", "compute_cost": 100}], "edges": []}
    config = {"scheduler": "all_on_fastest", "seed": 7}
    body = {"network": {"nodes": nodes, "links": links}, "dags": [dag], "config": config}
    path.write_text(json.dumps({"scenario": body}), encoding="utf-8")
    return path


def test_a_scenario_needs_no_import(tmp_path, capsys):
    (tmp_path / "mine.yaml").write_text("scenario: {}")

    assert ncsim("import", tmp_path / "mine.yaml") == 1
    assert "need no import: ncsim run" in capsys.readouterr().err


def test_without_a_scenario_the_dag_is_printed(capsys):
    assert ncsim("import", FILM, "--id", "film", "--at", "1.5") == 0

    printed = capsys.readouterr()
    [dag] = yaml.safe_load(printed.out)["dags"]
    assert (dag["id"], dag["inject_at"], len(dag["tasks"])) == ("film", 1.5, 6)
    assert "6 tasks, 8 dependencies, 63.5 MB between tasks" in printed.err
    assert "40 MB that no task writes, 12 MB that no task reads" in printed.err


@pytest.mark.parametrize("name", ["made.yaml", "made.json"])
def test_with_a_scenario_a_file_is_written_that_runs(name, host, tmp_path, capsys):
    path = tmp_path / name

    assert ncsim("import", FILM, "--into", host, "-o", path) == 0
    assert load_scenario(path).config.seed == 7
    assert ncsim("run", path, "--json") == 0
    assert json.loads(capsys.readouterr().out)["makespan_s"] == pytest.approx(33.5)


def test_dags_of_the_scenario_can_stay(host, tmp_path):
    path = tmp_path / "made.yaml"

    assert ncsim("import", FILM, "--into", host, "--keep", "-o", path) == 0
    scenario = load_scenario(path)
    assert [each.dag.id for each in scenario.injections] == ["own", "film page"]
    assert scenario.config.components["dag_source"].name == "multi"


def test_a_scheduler_that_needs_pins_is_told_of(host, capsys):
    host.write_text(
        host.read_text()
        .replace("all_on_fastest", "manual")
        .replace(': 100}], "e', ': 100, "pinned_to": "a"}], "e'),
        encoding="utf-8",
    )

    assert ncsim("import", FILM, "--into", host) == 1
    assert "scheduler manual needs pinned_to on every task" in capsys.readouterr().err


def test_nothing_is_replaced(host, capsys):
    assert ncsim("import", FILM, "-o", host) == 1
    assert "exists already" in capsys.readouterr().err
    assert ncsim("import", FILM, "--keep") == 1
    assert "--keep needs --into" in capsys.readouterr().err


@pytest.mark.parametrize("option", [["--at", "inf"], ["--at", "nan"], ["--speed", "nan"]])
def test_times_and_speeds_must_be_finite(option, capsys):
    assert ncsim("import", FILM, *option) == 1
    assert "must be " in capsys.readouterr().err
