"""What fuzzing found, and what it keeps as a beginning, goes through every target again."""

import json
import resource
import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from ncsim_core.scenario.faults import ScenarioFaults
from ncsim_core.scenario.loader import parse_scenario
from ncsim_core.scenario.wording import MAX_COMPARISONS, Hints
from ncsim_core.sweep.reading import load_sweep

HERE = Path(__file__).parent
TARGETS = runpy.run_path(str(HERE / "targets.py"))["TARGETS"]
CORPUS = sorted((HERE / "corpus").glob("*/*"))
MEGABYTE = 1_000_000
GIGABYTE = 1 << 30

READ_SEVERAL = """
import sys
from ncsim_core.scenario.faults import ScenarioFaults
from ncsim_core.scenario.loader import load_scenario
for path in sys.argv[1:]:
    try:
        load_scenario(path)
    except ScenarioFaults as error:
        assert all(fault.line for fault in error.faults), path
        assert len(str(error)) < 20_000, path
    else:
        raise AssertionError(path)
"""


@pytest.mark.parametrize("name", TARGETS)
def test_every_input_of_the_corpus_is_accepted_or_cleanly_refused(name):
    inputs = [path for path in CORPUS if path.parent.name == name]
    assert inputs

    for path in inputs:
        TARGETS[name](path.read_bytes())


def cycle_of(length):
    tasks = "".join(f"      - {{id: t{k}, compute_cost: 1}}\n" for k in range(length))
    ends = [(k, (k + 1) % length) for k in range(length)]
    edges = "".join(f"      - {{from: t{a}, to: t{b}, data_size: 1}}\n" for a, b in ends)
    nodes = "scenario:\n  network:\n    nodes: [{id: a, compute_capacity: 1}]\n"
    return f"{nodes}  dags:\n   - id: d\n     tasks:\n{tasks}     edges:\n{edges}"


BOMB = "".join(f"  b{k + 1}: &b{k + 1} [{','.join([f'*b{k}'] * 9)}]\n" for k in range(30))
NASTY = {
    "deep.yaml": "[" * MEGABYTE,
    "deep.json": '{"a":' * (MEGABYTE // 5),
    "bomb.yaml": f"scenario:\n  b0: &b0 [1]\n{BOMB}",
    "line.yaml": "scenario: " + "x" * MEGABYTE,
    "number.yaml": "scenario: " + "9" * MEGABYTE,
    "number.json": '{"scenario": ' + "9" * MEGABYTE + "}",
    "documents.yaml": "---\n" * (MEGABYTE // 4),
    "keys.yaml": "? " * (MEGABYTE // 2),
    "nul.yaml": "a" * MEGABYTE + "\0",
    "cycle.yaml": cycle_of(4000),
}


def test_a_megabyte_of_anything_is_refused_with_a_place_in_less_than_a_gigabyte(tmp_path):
    for name, text in NASTY.items():
        (tmp_path / name).write_text(text, encoding="utf-8")

    done = subprocess.run(
        [sys.executable, "-c", READ_SEVERAL, *map(str, sorted(tmp_path.iterdir()))],
        capture_output=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (GIGABYTE, GIGABYTE)),
    )

    assert done.returncode == 0, done.stderr.decode()[-2000:]


TASKS = [f"t{number}" for number in range(4000)]
GOLDEN = HERE.parent / "integration" / "data" / "golden.trace.jsonl"
HEADER = GOLDEN.read_text(encoding="utf-8").splitlines(keepends=True)[0]
SWEEP = "sweep: {base: {network: {type: line, nodes: 2}, dags: {type: chain, tasks: 2}}, vary: "


def workflow_of(**task):
    rows = [{"id": each, "parents": [], **task} for each in TASKS]
    specification = {"tasks": rows, "files": [{"id": "f", "sizeInBytes": 1}]}
    measured = [{"id": each, "runtimeInSeconds": 1} for each in TASKS]
    return json.dumps(
        {"workflow": {"specification": specification, "execution": {"tasks": measured}}}
    )


def injection(tasks, edges):
    rows = {"tasks": tasks, "edges": edges}
    return HEADER + json.dumps({"t": 0, "k": "inject", "d": 0, "dag": "x", "i0": 0, "x0": 0} | rows)


HEAVY = [
    ("workflow", workflow_of(parents=[f"no{number}" for number in range(8)])),
    ("workflow", workflow_of(inputFiles=["f"], outputFiles=["f"])),
    ("trace", injection([["a", 1.0]] * (MEGABYTE // 12), [])),
    ("trace", injection([["a", 1.0]] * 2, [[0, 1, 1.0]] * (MEGABYTE // 13))),
    ("sweep", f"{SWEEP}{{{', '.join(f'rf.x{number}: [1]' for number in range(50_000))}}}}}"),
    ("sweep", f"{SWEEP}{{rf.tx_power_dBm: [{', '.join(map(str, range(150_000)))}]}}}}"),
    ("settings", "a=1\n" * (MEGABYTE // 4)),
    ("posted", json.dumps({"yaml": "a: [\n" * (MEGABYTE // 6)})),
    ("study", json.dumps({"plan": [["x", "y", "{}" * 100_000, 1, 1]], "member": [], "result": []})),
    *(
        (name, "[" * MEGABYTE)
        for name in ("workflow", "trace", "sweep", "settings", "posted", "page")
    ),
]
USE_SEVERAL = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from targets import TARGETS
for path in map(Path, sys.argv[2:]):
    TARGETS[path.suffix[1:]](path.read_bytes())
"""


def test_a_megabyte_of_anything_that_is_read_takes_less_than_a_gigabyte(tmp_path):
    for number, (name, text) in enumerate(HEAVY):
        (tmp_path / f"{number}.{name}").write_text(text, encoding="utf-8")

    done = subprocess.run(
        [sys.executable, "-c", USE_SEVERAL, str(HERE), *map(str, sorted(tmp_path.iterdir()))],
        capture_output=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (GIGABYTE, GIGABYTE)),
    )

    assert done.returncode == 0, done.stderr.decode()[-2000:]


def test_a_device_that_never_ends_is_refused():
    with pytest.raises(ScenarioFaults, match="is larger than 256 MiB; no scenario is"):
        load_sweep({"sweep": {"base": {"scenario": "/dev/zero"}}})


def test_suggestions_are_given_only_as_long_as_they_are_cheap():
    few, many = Hints(["node-1"]), Hints([f"node-{k}" for k in range(MAX_COMPARISONS)])

    assert [few.hint("nod-1") for _ in range(9)] == ["node-1"] * 9
    assert many.hint("nod-1") == "node-1"
    assert many.hint("nod-1") is None


def test_a_long_cycle_is_shown_without_its_middle():
    with pytest.raises(ScenarioFaults) as caught:
        parse_scenario(cycle_of(100))

    (fault,) = caught.value.faults
    assert "(81 more)" in fault.message
    assert len(fault.message) < 300


def sweep_with(**more):
    base = {
        "network": {"type": "paper_grid", "size": 2, "bandwidth_MBps": 5},
        "dags": {"type": "chain", "tasks": 3},
        "config": {"scheduler": "round_robin", "interference": "none"},
    }
    return {"sweep": {"base": base, **more}}


def generated(part, **parameters):
    sweep = sweep_with()
    sweep["sweep"]["base"][part] = parameters
    return sweep


POWERS = [f"rf.{name}" for name in ("tx_power_dBm", "freq_ghz", "shadow_fading_sigma")]
GIGANTIC = {
    "seeds": (sweep_with(replicate={"seeds": 10**12}), "more than 1000000 seeds"),
    "count": (
        sweep_with(vary={"rf.freq_ghz": {"from": 1, "to": 2, "count": 10**12}}),
        "more than 10000",
    ),
    "step": (
        sweep_with(vary={"rf.freq_ghz": {"from": 1, "to": 2, "step": 1e-300}}),
        "more than 10000",
    ),
    "infinite range": (
        sweep_with(vary={"rf.freq_ghz": {"from": -1e308, "to": 1e308}}),
        "more than 10000",
    ),
    "list": (sweep_with(vary={"rf.freq_ghz": [*range(10_001)]}), "more than 10000"),
    "axes": (sweep_with(vary={f"rf.x{k}": [1] for k in range(201)}), "varies 201 things"),
    "runs": (
        sweep_with(vary={p: {"from": 1, "to": 5, "count": 1000} for p in POWERS}),
        "more than 10000000 runs",
    ),
    "condition": (
        sweep_with(vary={"network.size": [2, 3]}, where="-" * 900 + "size > 1"),
        "nested too deeply",
    ),
    "nodes": (generated("network", type="paper_grid", size=10**6), "more than 1,000,000 parts"),
    "tasks": (generated("dags", type="chain", tasks=10**8), "more than 1,000,000 parts"),
    "tree": (
        generated("dags", type="out_tree", depth=20, branching=100),
        "more than 1,000,000 parts",
    ),
    "dags": (generated("dags", type="chain", tasks=2, count=10**9), "more than 1,000,000 parts"),
}


@pytest.mark.parametrize("what", GIGANTIC)
def test_sweeps_that_would_fill_the_memory_are_refused_when_they_are_read(what):
    sweep, message = GIGANTIC[what]

    with pytest.raises(ScenarioFaults, match=message):
        load_sweep(sweep)
