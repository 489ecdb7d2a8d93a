"""Same scenario, same seed, same bytes."""

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest
from ncsim_core.api import prepare
from ncsim_core.scenario.loader import load_scenario
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


if __name__ == "__main__":
    GOLDEN.write_text(trace_here(), encoding="utf-8")
