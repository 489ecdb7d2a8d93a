"""HEFT and CPOP place the paper's workflows as published, by every engine and hash seed."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from ncsim_core.workflow import DAG, Dependency, Task
from ncsim_saga.native.array_processors import ArrayProcessors
from ncsim_saga.native.cpop import cpop
from ncsim_saga.native.heft import heft
from ncsim_saga.native.instance import instance_of
from ncsim_saga.native.planning_network import planning_network
from ncsim_saga.native.processors import ListProcessors
from ncsim_saga.planning import PlanRequest, plan_with_saga
from ncsim_saga.virtual_network import VirtualNetwork

STUDY = json.loads((Path(__file__).parent / "data" / "paper_placements.json").read_text("utf-8"))
NATIVE = {"heft": heft, "cpop": cpop}


def virtual(row):
    speeds = {"-": 10_000.0, **STUDY["goodput_MBps"]}
    codes = STUDY["bottlenecks"][f"{row['grid']} {row['routing']}"]
    return VirtualNetwork(
        tuple(map(float, STUDY["capacities"][: len(codes)])),
        tuple(tuple(speeds[code] for code in line) for line in codes),
    )


def dag_of_study(row):
    size = str(row["tasks"])
    return DAG(
        "dag",
        tuple(Task(name, 500.0) for name in STUDY["tasks"][size]),
        tuple(Dependency(*ends.split(), 10.0) for ends in STUDY["dependencies"][size]),
    )


def by_saga(row):
    return plan_with_saga(PlanRequest(row["scheduler"], virtual(row), dag_of_study(row)))


def natively(row, kind):
    dag, network = dag_of_study(row), planning_network(virtual(row))
    positions = NATIVE[row["scheduler"]](instance_of(dag), kind(network, 500.0))
    return {
        task.id: network.nodes[position]
        for task, position in zip(dag.tasks, positions, strict=True)
    }


ENGINES = {
    "saga": by_saga,
    "lists": lambda row: natively(row, ListProcessors),
    "arrays": lambda row: natively(row, ArrayProcessors),
}


def differing(engine):
    """Return the rows that an engine places otherwise."""
    return [
        row
        for row in STUDY["placements"]
        if dict(each.split(":") for each in row["placement"].split())
        != {task: f"n{node}" for task, node in ENGINES[engine](row).items()}
    ]


def test_all_pairs_of_grid_dag_and_routing_are_there():
    assert len(STUDY["placements"]) == 36


@pytest.mark.parametrize("engine", ENGINES)
def test_every_engine_places_as_published(engine):
    assert differing(engine) == []


@pytest.mark.parametrize("seed", ["0", "1", "random"])
def test_placements_are_those_published_under_every_hash_seed(seed):
    code = (
        f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r});"
        "from test_paper_placements import ENGINES, differing;"
        "print([len(differing(engine)) for engine in ENGINES])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"PYTHONHASHSEED": seed},
        capture_output=True,
        text=True,
        check=True,
    )

    assert done.stdout.strip() == "[0, 0, 0]"
