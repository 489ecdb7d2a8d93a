"""Same scenario, same seed, same bytes."""

import io
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from ncsim_core.api import prepare
from ncsim_core.scenario.loader import load_scenario
from ncsim_core.sweep.running import run_sweep
from ncsim_core.trace.writer import TraceWriter

GRID = Path(__file__).parents[2] / "examples" / "grid_4x4.yaml"
GOLDEN = Path(__file__).parent / "data" / "golden.trace.jsonl"
PRINT_TRACE = f"""
import sys
from ncsim_core.api import prepare
from ncsim_core.trace.writer import TraceWriter
prepare({str(GRID)!r}, observers=[TraceWriter(sys.stdout)]).run()
"""


def trace_here():
    text = io.StringIO()
    prepare(load_scenario(GRID), observers=[TraceWriter(text)]).run()
    return text.getvalue()


def trace_elsewhere(**environment):
    done = subprocess.run(
        [sys.executable, "-c", PRINT_TRACE],
        env=os.environ | environment,
        capture_output=True,
        check=True,
    )
    return done.stdout.decode()


def test_two_runs_in_one_process_give_the_same_bytes():
    assert trace_here() == trace_here()


@pytest.mark.parametrize(
    "environment",
    [
        {"PYTHONHASHSEED": "0"},
        {"PYTHONHASHSEED": "1"},
        {"PYTHONHASHSEED": "random"},
        {"LC_ALL": "C", "PYTHONUTF8": "1"},
        {"LC_ALL": "tr_TR.UTF-8", "TZ": "Asia/Kathmandu"},
    ],
    ids=lambda environment: "-".join(f"{key}={value}" for key, value in environment.items()),
)
def test_other_processes_give_the_same_bytes(environment):
    assert trace_elsewhere(**environment) == trace_here()


def test_the_bytes_are_those_of_the_golden_trace():
    # Any Python version and machine must agree. After a wanted change of models or format,
    # write it anew and read the difference:  python tests/integration/test_determinism.py
    assert trace_here() == GOLDEN.read_text(encoding="utf-8")


PRINT_TRACE_OF_MODEL = f"""
import os, sys
if os.environ["NCSIM_PURE"] != "1":
    import numba  # once it is there, compiled loops are used from the first step on
from ncsim_core.api import prepare
from ncsim_core.trace.writer import TraceWriter
prepare({str(GRID)!r}, observers=[TraceWriter(sys.stdout)], interference=sys.argv[1]).run()
"""
FORMS = [
    {"NCSIM_PURE": "1", "PYTHONHASHSEED": "0", "LC_ALL": "C", "TZ": "UTC"},
    {"NCSIM_PURE": "0", "PYTHONHASHSEED": "1", "LC_ALL": "tr_TR.UTF-8", "TZ": "Asia/Kathmandu"},
]


@pytest.mark.skipif(not find_spec("numba"), reason="numba is not installed")
@pytest.mark.parametrize("model", ["csma_bianchi", "csma_clique", "csma_spatial"])
def test_compiled_or_not_each_radio_model_gives_the_same_bytes_in_any_process(model):
    pure, compiled = (
        subprocess.run(
            [sys.executable, "-c", PRINT_TRACE_OF_MODEL, model],
            env=os.environ | environment,
            capture_output=True,
            check=True,
        ).stdout
        for environment in FORMS
    )

    assert compiled == pure
    assert b'"k":"done","status":"completed"' in pure


RUN_AND_HASH = f"""
import hashlib, sys, tempfile
from pathlib import Path
from ncsim_core.cli.main import exit_code_of
from ncsim_core.cli.verbs import app
with tempfile.TemporaryDirectory() as folder:
    out = Path(folder, "out")
    words = ["run", {str(GRID)!r}, "-o", str(out), "--gzip", "--quiet"]
    exit_code_of(lambda: app(args=words, standalone_mode=False))
    for name in ("scenario.yaml", "metrics.json", "trace.jsonl.gz"):
        sys.stderr.write(name + " " + hashlib.sha256((out / name).read_bytes()).hexdigest() + " ")
"""


def folder_hashes(**environment):
    done = subprocess.run(
        [sys.executable, "-c", RUN_AND_HASH],
        env=os.environ | environment,
        capture_output=True,
        check=True,
    )
    assert done.stderr.count(b" ") == 6
    return done.stderr


def test_all_files_of_a_run_but_its_circumstances_are_equal_everywhere():
    plain = folder_hashes(PYTHONHASHSEED="3", LC_ALL="C", TZ="UTC")
    other = folder_hashes(PYTHONHASHSEED="4", LC_ALL="tr_TR.UTF-8", TZ="Asia/Kathmandu")

    assert plain == other


SWEEP = {
    "sweep": {
        "base": {
            "network": {"type": "random_geometric", "nodes": 6, "side_m": 80, "range_m": 60},
            "dags": {"type": "layered_random", "layers": 3, "width": 3},
            "config": {"interference": "csma_bianchi", "routing": "widest_path"},
        },
        "vary": {"scheduler": ["heft", "cpop", "round_robin"]},
        "replicate": {"seeds": 3},
    }
}


def results(**options):
    with run_sweep(SWEEP, **options) as study:
        rows = sorted(study, key=lambda row: (row["scheduler"], row["seed"]))
    return [{name: value for name, value in row.items() if name != "wall_s"} for row in rows]


def test_workers_and_pools_change_no_result():
    serial = results(executor="serial")

    assert len(serial) == 9
    assert results(workers=1) == serial
    assert results(workers=3) == serial


OTHERS = os.environ.get("NCSIM_OTHER_PYTHONS", "").split()


@pytest.mark.skipif(not OTHERS, reason="NCSIM_OTHER_PYTHONS lists no interpreters with ncsim")
@pytest.mark.parametrize("python", OTHERS or [""])
def test_other_python_versions_give_the_bytes_of_the_golden_trace(python):
    done = subprocess.run([python, "-c", PRINT_TRACE], capture_output=True, check=True)

    assert done.stdout == GOLDEN.read_bytes()


if __name__ == "__main__":
    GOLDEN.write_text(trace_here(), encoding="utf-8")
