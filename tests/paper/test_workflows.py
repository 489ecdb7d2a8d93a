"""Every run of the paper's workflow studies, to the microsecond, under any hash seed."""

import json
import os
import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from ncsim_core import simulate
from ncsim_core.generators.paper import paper_dag, paper_grid
from ncsim_core.scenario.making import make_scenario
from ncsim_core.units import us_from_s
from ncsim_core.workflow import Injection

STUDY = Path(__file__).parent / "run_workflows.py"
ROWS = runpy.run_path(str(STUDY))["rows"]()
TOLERANCE_s = 2e-6


def name_of(row):
    payload = f"-{row['payload_MB']}MB" if "payload_MB" in row else ""
    parts = (f"{row['grid']}x{row['grid']}", row["tasks"], row["routing"], row["scheduler"])
    return "-".join(map(str, (*parts, row["mode"]))) + payload


@pytest.fixture(scope="module", params=["0", "1", "random"])
def answers(request):
    environment = os.environ | {"PYTHONHASHSEED": request.param}
    done = subprocess.run(
        [sys.executable, str(STUDY)], env=environment, capture_output=True, text=True, check=True
    )
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_the_studies_have_150_runs(answers):
    assert len(ROWS) == len(answers) == 150


@pytest.mark.parametrize("number", range(len(ROWS)), ids=[name_of(row) for row in ROWS])
def test_makespan_and_placement_are_those_of_the_paper(answers, number):
    row, answer = ROWS[number], answers[number]

    assert answer["status"] == "completed"
    assert answer["makespan_s"] == pytest.approx(row["makespan_s"], rel=0, abs=TOLERANCE_s)
    assert answer["remote_MB"] == row["remote_MB"]
    if "placement" in row:
        assert answer["placement"] == dict(pair.split(":") for pair in row["placement"].split())
        assert answer["route_work_MB_hops"] == row["route_work_MB_hops"]


@pytest.mark.parametrize(("routing", "work_MB_hops"), [("widest_path", 880), ("minimum_hop", 260)])
def test_route_work_of_the_4x4_grid_with_20_tasks(routing, work_MB_hops):
    config = {"scheduler": "heft", "routing": routing, "interference": "csma_bianchi"}

    result = simulate(make_scenario("load", paper_grid(4), [paper_dag(20)], config))

    assert result.remote_MB == 130
    assert result.route_work_MB_hops == work_MB_hops


@pytest.mark.parametrize("interference", ["none", "csma_bianchi"])
@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
def test_concurrent_workflows_queue_on_the_fastest_node(count, interference):
    config = {
        "scheduler": "heft",
        "routing": "minimum_hop",
        "link_model": "wifi",
        "interference": interference,
    }
    injections = [
        Injection(us_from_s(0.5 * k), paper_dag(5, dag_id=f"dag_{k}")) for k in range(count)
    ]

    result = simulate(make_scenario("concurrent", paper_grid(3), injections, config))

    assert result.transfers == ()
    assert set(result.placement.values()) == {"n4"}
    rounding_s = 5 * count * 0.5e-6  # each task rounds to a microsecond
    assert result.makespan_s == pytest.approx(25 / 3 * count, abs=rounding_s)
