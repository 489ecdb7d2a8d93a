"""What a command imports, by ``sys.modules``; CPU times are in ``benchmarks/start_up.py``."""

import json
import subprocess
import sys

import pytest

NEVER_FOR_A_SMALL_RUN = {
    "jsonschema",
    "networkx",
    "numpy",
    "packaging",
    "pandas",
    "pydantic",
    "rich",
    "saga",
    "scipy",
}
NEVER_FOR_HELP = NEVER_FOR_A_SMALL_RUN | {"pluggy", "typer", "yaml"}

SCENARIO = {
    "scenario": {
        "network": {
            "nodes": [{"id": f"n{k}", "compute_capacity": 100 + k} for k in range(4)],
            "links": [
                {"id": f"l{a}{b}", "from": f"n{a}", "to": f"n{b}", "bandwidth": 5}
                for a in range(4)
                for b in range(4)
                if a != b
            ],
        },
        "dags": [
            {
                "id": "d",
                "tasks": [{"id": f"T{k}", "compute_cost": 100} for k in range(6)],
                "edges": [{"from": "T0", "to": f"T{k}", "data_size": 2} for k in range(1, 6)],
            }
        ],
        "config": {"scheduler": "heft", "routing": "minimum_hop"},
    }
}


def imported_by(*args):
    code = (
        "import sys\n"
        "from ncsim_core.cli.main import main\n"
        "try:\n    main(sys.argv[1:])\n"
        "except SystemExit as stop:\n    assert not stop.code, stop.code\n"
        "print('LOADED', *sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, *map(str, args)], capture_output=True, text=True, check=True
    )
    return set(done.stdout.rpartition("LOADED")[2].split())


@pytest.mark.parametrize("word", ["--help", "--version"])
def test_the_front_page_imports_no_parser(word):
    assert imported_by(word) & NEVER_FOR_HELP == set()


def test_a_small_run_with_heft_imports_nothing_heavy(tmp_path):
    path = tmp_path / "small.yaml"
    path.write_text(json.dumps(SCENARIO), encoding="utf-8")

    assert imported_by("run", path, "-o", tmp_path / "out") & NEVER_FOR_A_SMALL_RUN == set()


def test_a_json_scenario_is_read_without_yaml(tmp_path):
    path = tmp_path / "small.json"
    path.write_text(json.dumps(SCENARIO), encoding="utf-8")

    assert "yaml" not in imported_by("run", path)


def test_validating_imports_no_engine(tmp_path):
    path = tmp_path / "small.json"
    path.write_text(json.dumps(SCENARIO), encoding="utf-8")

    loaded = imported_by("validate", path)
    assert loaded & NEVER_FOR_A_SMALL_RUN == set()
    assert [name for name in loaded if name.startswith("ncsim_core.engine")] == []
